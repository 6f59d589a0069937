#include <semloop/slam/LoopCloser.h>

#include <map>
#include <utility>

using mrpt::poses::CPose3D;

namespace semloop
{
LoopCloser::LoopCloser(
	CObjectMap::Ptr map, std::shared_ptr<PoseGraph> poseGraph,
	std::shared_ptr<const LoopDetector> detector, StageTimings& timings)
	: map_(std::move(map)),
	  poseGraph_(std::move(poseGraph)),
	  detector_(std::move(detector)),
	  timings_(timings)
{
}

LoopVerdict LoopCloser::detect(const LocalMap& localMap) const
{
	const StageTimings::Scope timing(timings_, "loop_detection");
	const std::set<ObjectId> local = localMap.query();
	std::set<ObjectId> query, target;
	for (const auto& [id, object] : map_->objects())
	{
		if (local.count(id))
			query.insert(id);
		else if (!localMap.contains(id))
			target.insert(id);
	}
	return detector_->detect(*map_, query, target);
}

OptimizationReport LoopCloser::close(
	const LoopVerdict& verdict, LocalMap& localMap, ObjectMapper& mapper)
{
	// Sec. III-D: "the camera pose and the object-camera constraint are corrected": what was measured
	// against the local object is a measurement of its partner from now on.
	std::map<ObjectId, std::pair<ObjectId, CPose3D>> partners;
	for (const auto& [query, target] : verdict.matches)
	{
		const CPose3D T_world_query = map_->object(query).T_world_object;
		const CPose3D T_world_target = map_->object(target).T_world_object;
		const CPose3D T_target_query = (-T_world_target) + (verdict.T_target_query + T_world_query);
		poseGraph_->mergeObjects(target, query, T_target_query, true);
		partners[query] = {target, T_target_query};
	}
	const OptimizationReport report = optimize();

	std::map<ObjectId, CPose3D> poses;
	for (const auto& [query, partner] : partners)
		poses[query] = map_->object(partner.first).T_world_object + partner.second;
	map_->moveObjects(poses);
	for (const auto& [query, partner] : partners)
	{
		map_->mergeObjects(partner.first, query);
		localMap.merge(partner.first, query);
		mapper.merge(partner.first, query);
	}
	localMap.loopClosed();
	mergeDuplicates(localMap, mapper);
	return report;
}

OptimizationReport LoopCloser::optimize()
{
	const StageTimings::Scope timing(timings_, "optimization");
	const OptimizationReport report = poseGraph_->optimize();
	std::map<ObjectId, CPose3D> poses;
	for (const auto& [node, pose] : poseGraph_->nodes())
		if (node.kind == NodeId::Kind::Object) poses[node.index] = pose;
	map_->moveObjects(poses);
	return report;
}

void LoopCloser::mergeDuplicates(LocalMap& localMap, ObjectMapper& mapper)
{
	for (auto pairs = map_->findDuplicates(); !pairs.empty(); pairs = map_->findDuplicates())
		for (const auto& [kept, absorbed] : pairs)
		{
			map_->mergeObjects(kept, absorbed);
			poseGraph_->removeObject(absorbed);
			localMap.merge(kept, absorbed);
			mapper.merge(kept, absorbed);
		}
}

}  // namespace semloop
