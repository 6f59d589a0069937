#pragma once

#include <semloop/loop_closure/PlaceSearch.h>
#include <semloop/loop_closure/YawPose.h>

#include <optional>
#include <vector>

#include "MatchCandidates.h"

namespace semloop
{
/** ln p(T): uniform over the map, or with a prior mostly its Gaussian. */
class PoseDensity
{
public:
	PoseDensity(
		const MatchCandidates& candidates, double area, double doubt,
		const std::optional<PosePrior>& prior);

	double log(const YawPose& pose) const;
	/** Mahalanobis distance from the prior; 0 without one. */
	double sigmas(const YawPose& pose) const;
	/** The yaw with the prior's, by their variances, for a pose near it; changes sigma [rad], too. */
	YawPose withPriorsYaw(
		const YawPose& pose, const mrpt::math::TPoint3D& pivot, double& yawSigma) const;
	/** The largest that log() can be. */
	double most() const { return most_; }

private:
	double turnToPrior(const YawPose& pose) const;

	mrpt::math::TPoint3D centroid_, expected_;  //!< of the query; where the prior puts it
	double uniform_;                            //!< [1 / (m^3 rad)]
	double peak_ = 0;                           //!< of the Gaussian [1 / (m^3 rad)]
	double yaw_ = 0;
	PosePrior prior_;
	double most_;
};

/** A pose with the matches that give it its evidence. */
struct Hypothesis
{
	YawPose pose;
	std::vector<Match> matches;
	double evidence = -1e300;
	double sigma = 0;     //!< of the matched centres [m]
	double yawSigma = 0;  //!< [rad]
};

/** The evidence of poses, see PlaceSearch. Keeps its scratch memory between calls. */
class PlaceEvidence
{
public:
	PlaceEvidence(
		const MatchCandidates& candidates, std::size_t targets, const PoseDensity& density,
		const PlaceSearchOptions& options);

	/** What these objects of the query say for a pose, at a middling sigma and not one to one: quick. A
	 *  result below `least` may be too large. `most` is mostSupport(queries). */
	double support(
		const YawPose& pose, const std::vector<std::size_t>& queries, double most,
		double least) const;
	double mostSupport(const std::vector<std::size_t>& queries) const;
	/** Candidates that support() has looked at so far. */
	std::ptrdiff_t work() const { return work_; }

	/** Climbs from the pose to the nearest best one. */
	Hypothesis refine(const YawPose& pose);

private:
	struct Pair
	{
		std::size_t query, target;
		double squaredDistance, weight, variance;
		mrpt::math::TPoint3D point;  //!< of the target
	};

	double supportBase() const;  //!< of a match at no distance, without its weight
	void findPairs(const YawPose& pose);
	void match(double sigma);
	std::vector<Match> matches() const;  //!< those of match(), by query index
	double evidence(const YawPose& pose, double sigma) const;
	double radius() const;  //!< R, of the matches [m]
	std::optional<YawPose> fit(double sigma) const;
	/** K_sigma over the density of anything else, as a logarithm. */
	double logKernel(double squaredDistance, double sigma) const;

	const MatchCandidates& candidates_;
	const PoseDensity& density_;
	const PlaceSearchOptions& options_;
	double logOdds_;  //!< ln P_m / (1 - P_m) V / (2 pi)^1.5
	std::vector<double> sigmas_;
	std::vector<float> mostSupport_;  //!< of each object of the query
	std::vector<Pair> pairs_;
	std::vector<std::pair<double, std::size_t>> ranked_;  //!< evidence and index of a pair
	std::vector<std::size_t> matched_;                    //!< indices of pairs_
	double matchedEvidence_ = 0;
	std::vector<int> usedQuery_, usedTarget_;  //!< the call that used it last
	int call_ = 0;
	mutable std::ptrdiff_t work_ = 0;
};

}  // namespace semloop
