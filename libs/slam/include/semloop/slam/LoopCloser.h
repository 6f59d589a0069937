#pragma once

#include <semloop/object_map/CObjectMap.h>
#include <semloop/pose_graph/PoseGraph.h>
#include <semloop/slam/LocalMap.h>
#include <semloop/slam/LoopRecord.h>
#include <semloop/slam/ObjectMapper.h>
#include <semloop/slam/StageTimings.h>

#include <memory>
#include <optional>
#include <set>

namespace semloop
{
/** Secs. III-C and III-D put together: finds the local map in the rest of the map and, when it is
 *  there, corrects the pose graph and with it the map. */
class LoopCloser
{
public:
	LoopCloser(
		CObjectMap::Ptr map, std::shared_ptr<PoseGraph> poseGraph,
		std::shared_ptr<LoopDetector> detector, StageTimings& timings);

	/** Query: the local map; target: everything else. */
	LoopVerdict detect(
		const LocalMap& localMap, const std::optional<PosePrior>& prior,
		const PriorOfObjects& priorOf);
	/** Carries out an accepted verdict: an edge joins each matched object of the local map to its
	 *  partner, and each matched camera to the earlier one, all poses are optimised, and the objects moved and merged, except where the other
	 *  measurements contradict the edge. The pose graph keeps both nodes of a merged object. Merged
	 *  objects leave the local map, so that the next loop closure measures how the drift goes on.
	 *  Throws std::logic_error, with nothing changed, on a verdict that breaks LoopVerdict's rules. */
	OptimizationReport close(const LoopVerdict& verdict, LocalMap& localMap, ObjectMapper& mapper);

	/** Optimises, and moves the objects to where the graph has them. */
	OptimizationReport optimize();
	/** Makes one of objects that stand in the same place, both in the local map or both outside: of one
	 *  inside and one outside, a loop closure may still tell the drift. Nothing was measured between
	 *  the two, so the pose graph stays as it is. */
	void mergeDuplicates(LocalMap& localMap, ObjectMapper& mapper);
	/** The same for all objects: the drift is known, or nothing is left to measure it. */
	void mergeAllDuplicates(LocalMap& localMap, ObjectMapper& mapper);

private:
	void addEdge(const CameraMatch& match);
	void addEdge(ObjectId query, ObjectId target, const MatchAlignment& alignment);
	void merge(ObjectId kept, ObjectId absorbed, LocalMap& localMap, ObjectMapper& mapper);
	void mergeDuplicatesAmong(std::set<ObjectId> objects, LocalMap& localMap, ObjectMapper& mapper);

	CObjectMap::Ptr map_;
	std::shared_ptr<PoseGraph> poseGraph_;
	std::shared_ptr<LoopDetector> detector_;
	StageTimings& timings_;
};

}  // namespace semloop
