#pragma once

#include <semloop/object_map/CObjectMap.h>
#include <semloop/pose_graph/PoseGraph.h>
#include <semloop/slam/LocalMap.h>
#include <semloop/slam/LoopRecord.h>
#include <semloop/slam/ObjectMapper.h>
#include <semloop/slam/StageTimings.h>

#include <memory>
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
		std::shared_ptr<const LoopDetector> detector, StageTimings& timings);

	/** Query: what the local map has built itself; target: everything that is not in the local map. */
	LoopVerdict detect(const LocalMap& localMap) const;
	/** Carries out an accepted verdict: each matched object of the local map becomes one with its
	 *  partner, all poses are optimised, and the objects moved and merged. */
	OptimizationReport close(const LoopVerdict& verdict, LocalMap& localMap, ObjectMapper& mapper);

	/** Optimises, and moves the objects to where the graph has them. */
	OptimizationReport optimize();
	/** Makes one of objects that by now stand in the same place. Nothing was measured between the two,
	 *  so the pose graph only forgets the absorbed one. */
	void mergeDuplicates(LocalMap& localMap, ObjectMapper& mapper);

private:
	CObjectMap::Ptr map_;
	std::shared_ptr<PoseGraph> poseGraph_;
	std::shared_ptr<const LoopDetector> detector_;
	StageTimings& timings_;
};

}  // namespace semloop
