#include <semloop/pose_graph/PoseResidual.h>
#include <semloop/slam/LoopCloser.h>

#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

using mrpt::poses::CPose3D;

namespace semloop
{
namespace
{
// A detector that measures no object by itself says that all move as one, to 5 cm and 3 degrees.
const Matrix6 kAsOneInformation = 400 * Matrix6::Identity();
// Of chi squared with six degrees of freedom.
constexpr double kQuantile999 = 22.46;

/** The optimised poses are where the edge measured them. */
bool agrees(const PoseEdge& edge, const PoseGraph& graph)
{
	const auto rigid = [](const CPose3D& pose) { return RigidTransform::fromPose(pose); };
	const Vector6 e =
		poseResidual(rigid(edge.Z_a_b), rigid(graph.pose(edge.a)), rigid(graph.pose(edge.b)));
	return e.dot(edge.information * e) < kQuantile999;
}

void requireConsistent(const LoopVerdict& verdict)
{
	std::set<ObjectId> seen;
	for (const auto& [query, target] : verdict.matches)
		if (!seen.insert(query).second || !seen.insert(target).second)
			throw std::logic_error("loop detector: an object is in two matches of one verdict");
	if (!verdict.alignments.empty() && verdict.alignments.size() != verdict.matches.size())
		throw std::logic_error("loop detector: not as many alignments as matches");
}
}  // namespace

LoopCloser::LoopCloser(
	CObjectMap::Ptr map, std::shared_ptr<PoseGraph> poseGraph,
	std::shared_ptr<LoopDetector> detector, StageTimings& timings)
	: map_(std::move(map)),
	  poseGraph_(std::move(poseGraph)),
	  detector_(std::move(detector)),
	  timings_(timings)
{
}

LoopVerdict LoopCloser::detect(
	const LocalMap& localMap, const std::optional<PosePrior>& prior, const PriorOfObjects& priorOf)
{
	const StageTimings::Scope timing(timings_, "loop_detection");
	LoopQuery asked{*map_, {}, {}, prior, priorOf, localMap.firstFrame()};
	for (const auto& [id, object] : map_->objects())
		(localMap.contains(id) ? asked.query : asked.target).insert(id);
	asked.T_world_camera = [this](std::size_t frame)
	{ return poseGraph_->pose(NodeId::camera(frame)); };
	return detector_->detect(asked);
}

OptimizationReport LoopCloser::close(
	const LoopVerdict& verdict, LocalMap& localMap, ObjectMapper& mapper)
{
	requireConsistent(verdict);
	const std::size_t before = poseGraph_->edges().size();
	for (std::size_t i = 0; i < verdict.matches.size(); ++i)
		addEdge(
			verdict.matches[i].first, verdict.matches[i].second,
			verdict.alignments.empty() ? MatchAlignment{verdict.T_target_query, kAsOneInformation}
									   : verdict.alignments[i]);
	for (const CameraMatch& match : verdict.cameras) addEdge(match);
	const std::vector<PoseEdge> edges(
		poseGraph_->edges().begin() + std::ptrdiff_t(before), poseGraph_->edges().end());
	const OptimizationReport report = optimize();
	for (const PoseEdge& edge : edges)
	{
		if (edge.a.kind != NodeId::Kind::Object || !agrees(edge, *poseGraph_)) continue;
		merge(edge.a.index, edge.b.index, localMap, mapper);
		localMap.remove(edge.a.index);
	}
	localMap.loopClosed();
	mergeAllDuplicates(localMap, mapper);
	return report;
}

void LoopCloser::addEdge(const CameraMatch& match)
{
	PoseEdge edge;
	edge.kind = PoseEdge::Kind::Loop;
	edge.a = NodeId::camera(match.target);
	edge.b = NodeId::camera(match.query);
	edge.Z_a_b = match.T_target_query;
	edge.information = match.information;
	poseGraph_->addEdge(edge);
}

// Sec. III-D: "the camera pose and the object-camera constraint are corrected". The paper rewrites what
// was measured against the local object; an edge to its partner says the same and how certain it is.
void LoopCloser::addEdge(ObjectId query, ObjectId target, const MatchAlignment& alignment)
{
	const Object& object = map_->object(query);
	PoseEdge edge;
	edge.kind = PoseEdge::Kind::Loop;
	edge.a = NodeId::object(target);
	edge.b = NodeId::object(query);
	edge.Z_a_b =
		(-map_->object(target).T_world_object) + (alignment.T_target_query + object.T_world_object);
	const CPose3D centre = CPose3D::FromTranslation(object.centre());
	const Matrix6 Ad = adjoint(RigidTransform::fromPose((-centre) + object.T_world_object));
	edge.information = Ad.transpose() * alignment.information * Ad;
	edge.information = 0.5 * (edge.information + edge.information.transpose()).eval();
	poseGraph_->addEdge(edge);
}

void LoopCloser::merge(ObjectId kept, ObjectId absorbed, LocalMap& localMap, ObjectMapper& mapper)
{
	map_->mergeObjects(kept, absorbed);
	localMap.merge(kept, absorbed);
	mapper.merge(kept, absorbed);
}

OptimizationReport LoopCloser::optimize()
{
	const StageTimings::Scope timing(timings_, "optimization");
	const OptimizationReport report = poseGraph_->optimize();
	std::map<ObjectId, CPose3D> poses;
	for (const auto& [node, pose] : poseGraph_->nodes())
		if (node.kind == NodeId::Kind::Object && map_->objects().count(node.index))
			poses[node.index] = pose;
	map_->moveObjects(poses);
	return report;
}

void LoopCloser::mergeDuplicates(LocalMap& localMap, ObjectMapper& mapper)
{
	std::set<ObjectId> inside, outside;
	for (const auto& [id, object] : map_->objects())
		(localMap.contains(id) ? inside : outside).insert(id);
	mergeDuplicatesAmong(std::move(inside), localMap, mapper);
	mergeDuplicatesAmong(std::move(outside), localMap, mapper);
}

void LoopCloser::mergeAllDuplicates(LocalMap& localMap, ObjectMapper& mapper)
{
	std::set<ObjectId> all;
	for (const auto& entry : map_->objects()) all.insert(entry.first);
	mergeDuplicatesAmong(std::move(all), localMap, mapper);
}

void LoopCloser::mergeDuplicatesAmong(
	std::set<ObjectId> objects, LocalMap& localMap, ObjectMapper& mapper)
{
	for (auto pairs = map_->findDuplicates(objects); !pairs.empty();
		 pairs = map_->findDuplicates(objects))
		for (const auto& [kept, absorbed] : pairs)
		{
			objects.erase(absorbed);
			merge(kept, absorbed, localMap, mapper);
		}
}

}  // namespace semloop
