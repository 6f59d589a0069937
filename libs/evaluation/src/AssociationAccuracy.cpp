#include <semloop/association/Assignment.h>
#include <semloop/evaluation/AssociationAccuracy.h>

#include <limits>
#include <map>

namespace semloop
{
namespace
{
using SharedBoxes = std::map<std::pair<uint32_t, ObjectId>, std::size_t>;

double intersectionOverUnion(const cv::Rect& a, const cv::Rect& b)
{
	const double shared = (a & b).area();
	const double all = double(a.area()) + b.area() - shared;
	return all > 0 ? shared / all : 0.0;
}

std::vector<IdentityMatch> matchIdentities(const SharedBoxes& shared)
{
	std::map<uint32_t, Eigen::Index> rows;
	std::map<ObjectId, Eigen::Index> columns;
	for (const auto& entry : shared)
	{
		rows.emplace(entry.first.first, Eigen::Index(rows.size()));
		columns.emplace(entry.first.second, Eigen::Index(columns.size()));
	}
	CostMatrix cost = CostMatrix::Zero(Eigen::Index(rows.size()), Eigen::Index(columns.size()));
	for (const auto& [ids, count] : shared)
		cost(rows.at(ids.first), columns.at(ids.second)) = -double(count);

	std::map<Eigen::Index, Eigen::Index> columnOf;
	for (const auto& [row, column] : solveAssignment(cost).matches)
		columnOf[Eigen::Index(row)] = Eigen::Index(column);
	std::vector<IdentityMatch> matches;
	for (const auto& [ids, count] : shared)
	{
		const auto match = columnOf.find(rows.at(ids.first));
		if (match != columnOf.end() && match->second == columns.at(ids.second))
			matches.push_back({ids.first, ids.second, count});
	}
	return matches;
}

std::optional<double> share(std::size_t part, std::size_t whole)
{
	if (whole == 0) return std::nullopt;
	return double(part) / double(whole);
}
}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> pairBoxes(
	const std::vector<TrueBox>& truth, const std::vector<AssociationRecord>& estimate,
	double minimumIou)
{
	CostMatrix cost(Eigen::Index(truth.size()), Eigen::Index(estimate.size()));
	for (std::size_t j = 0; j < truth.size(); j++)
		for (std::size_t k = 0; k < estimate.size(); k++)
		{
			const double iou = intersectionOverUnion(truth[j].box, estimate[k].box);
			cost(Eigen::Index(j), Eigen::Index(k)) =
				iou >= minimumIou ? 1 - iou : std::numeric_limits<double>::infinity();
		}
	return solveAssignment(cost).matches;
}

AssociationAccuracy associationAccuracy(
	const std::vector<RunFrame>& frames, std::size_t minimumPixels)
{
	AssociationAccuracy result;
	result.frames = frames.size();
	SharedBoxes shared;
	for (const RunFrame& frame : frames)
	{
		for (const TrueBox& box : frame.truth) result.trueBoxes += box.pixels >= minimumPixels;
		for (const auto& [j, k] : pairBoxes(frame.truth, frame.estimate))
		{
			if (frame.truth[j].pixels < minimumPixels) continue;
			result.detectedBoxes++;
			shared[{frame.truth[j].object, frame.estimate[k].object}]++;
		}
	}
	result.matches = matchIdentities(shared);
	for (const IdentityMatch& match : result.matches) result.correct += match.sharedBoxes;
	result.accuracy = share(result.correct, result.trueBoxes);
	result.accuracyOfDetected = share(result.correct, result.detectedBoxes);
	return result;
}

}  // namespace semloop
