#include <semloop/association/Assignment.h>
#include <semloop/evaluation/ObjectEvaluation.h>
#include <semloop/evaluation/UprightBox.h>

#include <algorithm>
#include <limits>
#include <set>

using mrpt::poses::CPose3D;

namespace semloop
{
namespace
{
/** An object in the true world. */
struct PlacedObject
{
	const GraphVertex* vertex = nullptr;
	mrpt::math::TPoint3D centre;
	std::optional<UprightBox> box;
};

std::vector<PlacedObject> placed(const SemanticGraph& graph, const CPose3D& T_truth_graph)
{
	std::vector<PlacedObject> objects;
	for (const GraphVertex& vertex : graph.vertices)
	{
		PlacedObject object{&vertex, T_truth_graph.composePoint(vertex.position), std::nullopt};
		if (vertex.extent)
		{
			const CPose3D T_graph_axes =
				vertex.orientation ? CPose3D(*vertex.orientation, 0, 0, 0) : CPose3D();
			const double yaw = (T_truth_graph + T_graph_axes).yaw();
			object.box = UprightBox{object.centre, *vertex.extent, yaw};
		}
		objects.push_back(object);
	}
	return objects;
}

ObjectMatch compare(const PlacedObject& estimate, const PlacedObject& truth)
{
	ObjectMatch match;
	match.estimate = estimate.vertex->id;
	match.truth = truth.vertex->id;
	match.centreError = estimate.centre.distanceTo(truth.centre);
	if (estimate.box && truth.box) match.boxIou = intersectionOverUnion(*estimate.box, *truth.box);
	match.sameLabel = estimate.vertex->label == truth.vertex->label;
	return match;
}

double costOf(const ObjectMatch& match, const ObjectGate& gate)
{
	const bool isNear = match.centreError <= gate.centreDistance;
	if (!isNear && match.boxIou.value_or(0) <= gate.boxIou)
		return std::numeric_limits<double>::infinity();
	return match.centreError + (match.sameLabel ? 0 : gate.centreDistance);
}

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

IndexPairs matchObjects(
	const std::vector<PlacedObject>& estimate, const std::vector<PlacedObject>& truth,
	const ObjectGate& gate)
{
	CostMatrix cost(Eigen::Index(estimate.size()), Eigen::Index(truth.size()));
	for (std::size_t j = 0; j < estimate.size(); j++)
		for (std::size_t k = 0; k < truth.size(); k++)
			cost(Eigen::Index(j), Eigen::Index(k)) = costOf(compare(estimate[j], truth[k]), gate);
	return solveAssignment(cost).matches;
}

bool isAt(const PlacedObject& estimate, const PlacedObject& truth, const ObjectGate& gate)
{
	if (truth.box) return contains(*truth.box, estimate.centre);
	return estimate.centre.distanceTo(truth.centre) <= gate.centreDistance;
}

std::vector<ObjectId> findDuplicates(
	const std::vector<PlacedObject>& estimate, const std::vector<PlacedObject>& truth,
	const IndexPairs& pairs, const ObjectGate& gate)
{
	std::set<std::size_t> matched;
	for (const auto& pair : pairs) matched.insert(pair.first);
	std::vector<ObjectId> duplicates;
	for (std::size_t j = 0; j < estimate.size(); j++)
		if (matched.count(j) == 0 &&
			std::any_of(
				pairs.begin(), pairs.end(),
				[&](const auto& pair) { return isAt(estimate[j], truth[pair.second], gate); }))
			duplicates.push_back(estimate[j].vertex->id);
	std::sort(duplicates.begin(), duplicates.end());
	return duplicates;
}

std::optional<double> share(double part, std::size_t whole)
{
	if (whole == 0) return std::nullopt;
	return part / double(whole);
}

void summarize(ObjectEvaluation& result)
{
	std::vector<double> errors;
	double iou = 0;
	std::size_t boxes = 0, rightLabels = 0;
	for (const ObjectMatch& match : result.matches)
	{
		errors.push_back(match.centreError);
		iou += match.boxIou.value_or(0);
		boxes += match.boxIou.has_value();
		rightLabels += match.sameLabel;
	}
	result.centreError = summarizeErrors(std::move(errors));
	result.meanBoxIou = share(iou, boxes);
	result.labelAccuracy = share(double(rightLabels), result.matches.size());
	result.precision = share(double(result.matches.size()), result.estimated);
	result.recall = share(double(result.found), result.truth);
}
}  // namespace

ObjectEvaluation evaluateObjects(
	const SemanticGraph& estimate, const SemanticGraph& truth, const CPose3D& T_truth_estimate,
	const ObjectGate& gate)
{
	const auto estimated = placed(estimate, T_truth_estimate), real = placed(truth, CPose3D());
	const bool tellsObservations = std::any_of(
		truth.vertices.begin(), truth.vertices.end(),
		[](const GraphVertex& vertex) { return vertex.observations > 0; });
	const auto wasToBeSeen = [&](const PlacedObject& object)
	{ return !tellsObservations || object.vertex->observations > 0; };

	ObjectEvaluation result;
	result.estimated = estimated.size();
	result.truth = std::size_t(std::count_if(real.begin(), real.end(), wasToBeSeen));
	const auto pairs = matchObjects(estimated, real, gate);
	for (const auto& [j, k] : pairs)
	{
		result.matches.push_back(compare(estimated[j], real[k]));
		result.found += wasToBeSeen(real[k]);
	}
	std::sort(
		result.matches.begin(), result.matches.end(),
		[](const ObjectMatch& a, const ObjectMatch& b) { return a.estimate < b.estimate; });
	result.duplicates = findDuplicates(estimated, real, pairs, gate);
	summarize(result);
	return result;
}

}  // namespace semloop
