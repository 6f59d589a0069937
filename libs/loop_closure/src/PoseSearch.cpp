#include "PoseSearch.h"

#include <semloop/association/Assignment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace semloop
{
namespace
{
using mrpt::math::TPoint3D;

constexpr double kMinBaseline = 0.2;  // horizontal, below it two centres do not tell the yaw [m]
constexpr int kMaxRefinements = 10;
constexpr std::size_t kRefinedRivals = 8;
// Among more consistent pairs of matches than this there are many right ones.
constexpr std::size_t kMatchPairs = 1000;
// A rival explains over 40 % of the query, so a sixth of the edges: this many find it.
constexpr std::size_t kRivalEdges = 300;

/** Every stride-th of `size` things are at most `limit`, evenly spread. */
std::size_t strideFor(std::size_t size, std::size_t limit)
{
	return (size + limit - 1) / limit;
}

using PointPair = std::pair<TPoint3D, TPoint3D>;

struct Hypothesis
{
	YawPose pose;
	Support support;

	bool betterThan(const Hypothesis& o) const
	{
		return std::tie(support.inliers, support.quality) >
			   std::tie(o.support.inliers, o.support.quality);
	}
};
}  // namespace

std::optional<YawPose> fitYawPose(const std::vector<PointPair>& pairs)
{
	if (pairs.empty()) return {};
	TPoint3D meanQ, meanT;
	for (const auto& [q, t] : pairs) meanQ += q, meanT += t;
	meanQ *= 1.0 / static_cast<double>(pairs.size());
	meanT *= 1.0 / static_cast<double>(pairs.size());
	double c = 0, s = 0;
	for (const auto& [q, t] : pairs)
	{
		const auto a = q - meanQ, b = t - meanT;
		c += a.x * b.x + a.y * b.y;
		s += a.x * b.y - a.y * b.x;
	}
	if (std::hypot(c, s) < 1e-9) return {};
	return YawPose::about(meanQ, meanT, c, s);
}

PoseSearch::PoseSearch(
	const SemanticGraph& query, const SemanticGraph& target, CandidateIndex index)
	: query_(query),
	  target_(target),
	  index_(std::move(index)),
	  counter_(index_, target.vertices.size())
{
	const auto queries = static_cast<double>(index_.queries());
	for (std::size_t j = 0; j < index_.queries(); ++j) centroid_ += queryPoint(j);
	centroid_ *= 1.0 / queries;
	for (std::size_t j = 0; j < index_.queries(); ++j)
		spread_ += mrpt::square(queryPoint(j).x - centroid_.x) +
				   mrpt::square(queryPoint(j).y - centroid_.y);
	spread_ /= queries;
}

/** Empty when the distances disagree, by more than sqrt(2) of a gate, or leave the yaw open. */
std::optional<YawPose> PoseSearch::poseFromTwo(
	const TPoint3D& q1, const TPoint3D& q2, const TPoint3D& t1, const TPoint3D& t2) const
{
	const auto dq = q2 - q1, dt = t2 - t1;
	if (std::abs(dq.z - dt.z) > M_SQRT2 * index_.verticalGate()) return {};
	const double lengthQ = std::hypot(dq.x, dq.y), lengthT = std::hypot(dt.x, dt.y);
	if (std::abs(lengthQ - lengthT) > M_SQRT2 * index_.horizontalGate()) return {};
	if (std::min(lengthQ, lengthT) < kMinBaseline) return {};
	return YawPose::about(
		(q1 + q2) * 0.5, (t1 + t2) * 0.5, dq.x * dt.x + dq.y * dt.y, dq.x * dt.y - dq.y * dt.x);
}

/** Matches all query vertices under the pose: as many as possible, at the least total misfit. */
Solution PoseSearch::explain(const YawPose& pose) const
{
	struct Entry
	{
		std::size_t row;
		std::size_t target;
		double misfit;
	};
	std::vector<Entry> entries;
	std::map<std::size_t, std::size_t> columnOf;
	std::vector<std::size_t> queryOfRow;
	for (std::size_t j = 0; j < index_.queries(); ++j)
	{
		const auto p = pose * queryPoint(j);
		const std::size_t before = entries.size();
		const auto [begin, end] = index_.near(j, p);
		for (const auto* candidate = begin; candidate != end; ++candidate)
			if (const double misfit = index_.misfit(p, *candidate); std::isfinite(misfit))
			{
				columnOf.emplace(candidate->target, columnOf.size());
				entries.push_back({queryOfRow.size(), candidate->target, misfit});
			}
		if (entries.size() > before) queryOfRow.push_back(j);
	}
	CostMatrix cost = CostMatrix::Constant(
		static_cast<Eigen::Index>(queryOfRow.size()), static_cast<Eigen::Index>(columnOf.size()),
		std::numeric_limits<double>::infinity());
	std::vector<std::size_t> targetOfColumn(columnOf.size());
	for (const auto& [target, column] : columnOf) targetOfColumn[column] = target;
	for (const auto& entry : entries) cost(entry.row, columnOf[entry.target]) = entry.misfit;

	Solution solution;
	solution.pose = pose;
	const auto assignment = solveAssignment(cost);
	solution.misfit = assignment.cost;
	for (const auto& [row, column] : assignment.matches)
	{
		solution.inliers.push_back({queryOfRow[row], targetOfColumn[column]});
		solution.rmse +=
			(pose * queryPoint(queryOfRow[row]) - targetPoint(targetOfColumn[column])).sqrNorm();
	}
	if (!solution.inliers.empty())
		solution.rmse = std::sqrt(solution.rmse / static_cast<double>(solution.inliers.size()));
	return solution;
}

Solution PoseSearch::refine(const YawPose& pose) const
{
	Solution best = explain(pose);
	for (int i = 0; i < kMaxRefinements; ++i)
	{
		std::vector<PointPair> pairs;
		for (const auto& [j, k] : best.inliers) pairs.emplace_back(queryPoint(j), targetPoint(k));
		const auto fitted = fitYawPose(pairs);
		if (!fitted) break;
		const Solution next = explain(*fitted);
		if (!next.betterThan(best)) break;
		best = next;
	}
	return best;
}

std::optional<Solution> PoseSearch::bestOf(const std::vector<Match>& matches)
{
	std::vector<YawPose> poses;
	for (std::size_t a = 0; a < matches.size(); ++a)
		for (std::size_t b = a + 1; b < matches.size(); ++b)
			if (const auto pose = poseFromTwo(
					queryPoint(matches[a].query), queryPoint(matches[b].query),
					targetPoint(matches[a].target), targetPoint(matches[b].target)))
				poses.push_back(*pose);

	std::optional<Hypothesis> best;
	for (std::size_t i = 0; i < poses.size(); i += strideFor(poses.size(), kMatchPairs))
	{
		const int atLeast = best ? best->support.inliers : 0;
		const Hypothesis hypothesis{poses[i], counter_.count(poses[i], atLeast)};
		if (!best || hypothesis.betterThan(*best)) best = hypothesis;
	}
	if (!best) return {};
	return refine(best->pose);
}

/** Root mean square, over the query's vertices, of the distance between where two poses put them:
 *  |a c - b c|^2 + |Ra - Rb|^2 spread, c the centroid. [m] */
double PoseSearch::poseDistance(const YawPose& a, const YawPose& b) const
{
	const double cosine = a.cosine * b.cosine + a.sine * b.sine;
	return std::sqrt(
		(a * centroid_ - b * centroid_).sqrNorm() + std::max(0.0, 2 - 2 * cosine) * spread_);
}

/** Two-point poses of all candidates of both ends of a query edge, for at most kRivalEdges edges. */
template <class Visit>
void PoseSearch::forEachCandidatePose(const Visit& visit) const
{
	const std::size_t stride = strideFor(query_.edges.size(), kRivalEdges);
	std::size_t edge = 0;
	for (const auto& [a, b] : query_.edges)
	{
		if (edge++ % stride != 0) continue;
		const auto &q1 = queryPoint(a), &q2 = queryPoint(b);
		const double reach =
			std::hypot(q2.x - q1.x, q2.y - q1.y) + M_SQRT2 * index_.horizontalGate();
		for (const auto& first : index_.of(a))
		{
			const auto [begin, end] = index_.range(b, first.x - reach, first.x + reach);
			for (const auto* second = begin; second != end; ++second)
			{
				if (second->target == first.target) continue;
				const auto pose = poseFromTwo(
					q1, q2, {first.x, first.y, first.z}, {second->x, second->y, second->z});
				if (pose) visit(*pose);
			}
		}
	}
}

int PoseSearch::bestRivalOf(const YawPose& ours, double rivalDistance)
{
	std::vector<Hypothesis> rivals;  // best first, at most kRefinedRivals
	forEachCandidatePose(
		[&](const YawPose& pose)
		{
			if (poseDistance(pose, ours) < rivalDistance) return;
			const bool full = rivals.size() == kRefinedRivals;
			const int atLeast = full ? rivals.back().support.inliers : 1;
			const Hypothesis rival{pose, counter_.count(pose, atLeast)};
			if (rival.support.inliers < atLeast || (full && !rival.betterThan(rivals.back())))
				return;
			if (full) rivals.pop_back();
			const auto place = std::find_if(
				rivals.begin(), rivals.end(), [&](const auto& o) { return rival.betterThan(o); });
			rivals.insert(place, rival);
		});

	int inliers = rivals.empty() ? 0 : rivals.front().support.inliers;
	for (const auto& rival : rivals)
	{
		const auto refined = refine(rival.pose);
		if (poseDistance(refined.pose, ours) >= rivalDistance)
			inliers = std::max(inliers, static_cast<int>(refined.inliers.size()));
	}
	return inliers;
}

}  // namespace semloop
