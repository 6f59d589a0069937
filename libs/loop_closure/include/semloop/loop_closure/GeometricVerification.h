#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphMatcher.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
struct GeometricVerificationOptions : Options
{
	double maxHorizontalError = 0.3;  //!< of an inlier's centre [m]
	double maxVerticalError = 0.25;   //!< of an inlier's centre [m]
	double minSimilarity = 0.3;  //!< of two objects that both have embeddings, to be re-matched
	int minInliers = 4;
	double minInlierShare = 0.5;  //!< inliers / query vertices
	double rivalDistance = 0.8;   //!< poses that move the query's centres this far apart differ [m]
	double maxRunnerUp = 0.85;    //!< more: ambiguous

	/** Public: the loop detector has these keys in its own section. */
	void describe(OptionFields& fields) override;
};

/** What the rigid check makes of a matching. */
struct GeometricVerification
{
	enum class Outcome
	{
		Confirmed,
		Refuted,   //!< no pose, or too few inliers
		Ambiguous  //!< another pose explains the query nearly as well
	};

	Outcome outcome = Outcome::Refuted;
	std::string reason;                   //!< one line with the numbers
	std::vector<Match> inliers;           //!< re-matched under the pose, by query index
	mrpt::poses::CPose3D T_target_query;  //!< x, y, z, yaw; meaningful with 2 inliers or more
	double rmse = 0.0;                    //!< of the inliers' centres [m]
	double runnerUp = 0.0;                //!< inliers of the best rival / ours, clipped to [0, 1]
};

/** Checks the matched centres with a rigid motion that keeps gravity (both worlds have z up), so with
 *  4 degrees of freedom, yaw and translation.
 *
 *  1. Every pair of matches whose horizontal and vertical distances agree is a hypothesis.
 *  2. Its support is counted over all query vertices: a vertex is explained by a target vertex of
 *     its label (and of similar embedding, when both have one) that lies within the two gates.
 *  3. The best hypothesis is refined: least squares on its inliers, all vertices matched again (by
 *     assignment), until nothing changes.
 *  4. Distances cannot tell a scene from its mirror image: a pose is refuted when a reflection of the
 *     query explains clearly more (ours / its inliers < maxRunnerUp).
 *  5. Uniqueness: pairs of all label-compatible candidates, not only of the matches, are hypotheses
 *     for a rival that moves the query's centres at least rivalDistance (root mean square) away from
 *     where our pose puts them. Its inliers / ours is runnerUp, both counted at gates of three
 *     standard deviations of what our pose leaves: in a precise map a rival has to be precise.
 *
 *  Nothing is left to chance: the search is exhaustive, except that of more than 1000 consistent
 *  pairs of matches, and of more than 300 query edges in step 5, every n-th is taken. An empty graph or fewer than two matches are Refuted. */
GeometricVerification verifyGeometry(
	const SemanticGraph& query, const SemanticGraph& target, const std::vector<Match>& matches,
	const GeometricVerificationOptions& options = {});

/** Yaw and translation that minimise sum |T q - t|^2 over the pairs (q, t), in closed form; empty when
 *  the horizontal positions do not determine the yaw (fewer than two, or all in one place). */
std::optional<mrpt::poses::CPose3D> fitYawAndTranslation(
	const std::vector<std::pair<mrpt::math::TPoint3D, mrpt::math::TPoint3D>>& pairs);

}  // namespace semloop
