#include <semloop/loop_closure/GeometricVerification.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "CandidateIndex.h"
#include "PoseSearch.h"

namespace semloop
{
namespace
{
// A noiseless map would leave no room for a rival at all.
constexpr double kLeastGateShare = 0.3;

/** Inliers of the best pose that differs from ours / our inliers. Both are counted at gates of three
 *  standard deviations of what ours leaves on an axis: in a precise map a rival has to be precise. */
double runnerUpOf(
	const SemanticGraph& query, const SemanticGraph& target, const CandidateIndex& index,
	const Solution& ours, double rivalDistance)
{
	const double sigma = ours.rmse / std::sqrt(3.0);
	const double shrink = std::clamp(3 * sigma / index.horizontalGate(), kLeastGateShare, 1.0);
	PoseSearch search(query, target, index.withGatesScaledBy(shrink));
	return static_cast<double>(search.bestRivalOf(ours.pose, rivalDistance)) /
		   std::max(1, search.inliersOf(ours.pose));
}

/** Query vertices that fit the matches after a reflection, which no drift can be. */
int inliersOfMirrorImage(
	const SemanticGraph& query, const SemanticGraph& target, const CandidateIndex& index,
	const std::vector<Match>& matches)
{
	PoseSearch search(query, target, index.mirrored());
	const auto best = search.bestOf(matches);
	return best ? static_cast<int>(best->inliers.size()) : 0;
}

std::string percent(double share)
{
	return std::to_string(std::lround(100 * share)) + " %";
}

std::string metres(double value)
{
	char text[32];
	std::snprintf(text, sizeof text, "%.2f m", value);
	return text;
}
}  // namespace

void GeometricVerificationOptions::describe(OptionFields& fields)
{
	fields.number(
		"max_horizontal_error", maxHorizontalError, 0.001, 10,
		"horizontal distance of an inlier's centres [m]");
	fields.number(
		"max_vertical_error", maxVerticalError, 0.001, 10,
		"vertical distance of an inlier's centres [m]");
	fields.number(
		"min_similarity", minSimilarity, -1, 1,
		"least similarity of the embeddings of two objects to be matched under a pose");
	fields.integer("min_inliers", minInliers, 2, 1000, "least number of consistent matches");
	fields.number(
		"min_inlier_share", minInlierShare, 0, 1, "consistent matches / objects of the query");
	fields.number(
		"rival_distance", rivalDistance, 0.01, 100,
		"a pose that moves the query's objects at least this far from ours is a rival [m]");
	fields.number(
		"max_runner_up", maxRunnerUp, 0, 1,
		"inliers of the best rival / ours; more is ambiguous, 1 switches the test off");
}

std::optional<mrpt::poses::CPose3D> fitYawAndTranslation(
	const std::vector<std::pair<mrpt::math::TPoint3D, mrpt::math::TPoint3D>>& pairs)
{
	const auto pose = fitYawPose(pairs);
	if (!pose) return {};
	return pose->toPose3D();
}

GeometricVerification verifyGeometry(
	const SemanticGraph& query, const SemanticGraph& target, const std::vector<Match>& matches,
	const GeometricVerificationOptions& options)
{
	using Outcome = GeometricVerification::Outcome;
	GeometricVerification result;
	if (matches.size() < 2)
	{
		result.reason = std::to_string(matches.size()) + " matches do not determine a pose";
		return result;
	}
	const CandidateIndex index(query, target, options);
	const auto best = PoseSearch(query, target, index).bestOf(matches);
	if (!best)
	{
		result.reason =
			"no two of the " + std::to_string(matches.size()) + " matches agree in their distances";
		return result;
	}
	result.inliers = best->inliers;
	result.T_target_query = best->pose.toPose3D();
	result.rmse = best->rmse;

	const auto inliers = static_cast<int>(best->inliers.size());
	const auto queries = static_cast<double>(query.vertices.size());
	const std::string found = std::to_string(inliers) + " of " +
							  std::to_string(query.vertices.size()) + " objects fit one pose";
	if (inliers < options.minInliers || inliers < options.minInlierShare * queries)
	{
		result.reason = "only " + found + ", needed are " + std::to_string(options.minInliers) +
						" and " + percent(options.minInlierShare);
		return result;
	}
	if (const int mirrored = inliersOfMirrorImage(query, target, index, matches);
		inliers < options.maxRunnerUp * mirrored)
	{
		result.reason = "only " + found + ", but " + std::to_string(mirrored) +
						" the mirror image of one: the arrangement is another";
		return result;
	}
	result.runnerUp = std::min(1.0, runnerUpOf(query, target, index, *best, options.rivalDistance));
	result.reason = found + " (rmse " + metres(result.rmse) + "), the best other pose has " +
					percent(result.runnerUp) + " of that";
	// At a limit of 1 the test is off: a better rival is clipped to 1.
	result.outcome =
		result.runnerUp > options.maxRunnerUp ? Outcome::Ambiguous : Outcome::Confirmed;
	return result;
}

}  // namespace semloop
