#pragma once

#include <semloop/loop_closure/GeometricVerification.h>

#include <vector>

#include "YawPose.h"

namespace semloop
{
/** The target vertices that may explain each query vertex: same label, similar embedding. */
class CandidateIndex
{
public:
	struct Candidate
	{
		double x, y, z;        //!< of the target vertex [m]
		double dissimilarity;  //!< 1 - similarity of the embeddings; 0 without
		std::size_t target;
	};

	CandidateIndex(
		const SemanticGraph& query, const SemanticGraph& target,
		const GeometricVerificationOptions& options);

	/** The same candidates for the query's mirror image. */
	CandidateIndex mirrored() const;
	CandidateIndex withGatesScaledBy(double factor) const;

	double horizontalGate() const { return horizontalGate_; }  //!< [m]
	double verticalGate() const { return verticalGate_; }      //!< [m]

	/** Of one query vertex, by x. */
	const std::vector<Candidate>& of(std::size_t query) const { return candidates_[query]; }
	/** The part of of(query) with x within the horizontal gate of p_target.x. */
	std::pair<const Candidate*, const Candidate*> near(
		std::size_t query, const mrpt::math::TPoint3D& p_target) const
	{
		return range(query, p_target.x - horizontalGate_, p_target.x + horizontalGate_);
	}
	/** The part of of(query) with x in [low, high]. */
	std::pair<const Candidate*, const Candidate*> range(
		std::size_t query, double low, double high) const;

	/** How badly the candidate explains a query vertex that stands at p_target: infinity outside the
	 *  gates; at most 3. */
	double misfit(const mrpt::math::TPoint3D& p_target, const Candidate& candidate) const;

	std::size_t queries() const { return candidates_.size(); }
	const mrpt::math::TPoint3D& position(std::size_t query) const { return positions_[query]; }

private:
	std::vector<mrpt::math::TPoint3D> positions_;
	std::vector<std::vector<Candidate>> candidates_;
	double horizontalGate_, verticalGate_;
};

/** Query vertices that a pose explains, each target vertex used once, nearest first come. */
struct Support
{
	int inliers = 0;
	double quality = 0;  //!< sum of (1 - misfit / 6): breaks ties between equal counts
};

/** Counts support; keeps its scratch memory between calls. */
class SupportCounter
{
public:
	SupportCounter(const CandidateIndex& index, std::size_t targets) : index_(index), used_(targets)
	{
	}

	/** Stops early, with fewer inliers than there are, once `atLeast` cannot be reached. */
	Support count(const YawPose& pose, int atLeast);

private:
	const CandidateIndex& index_;
	std::vector<int> used_;  //!< the call that took this target last
	int call_ = 0;
};

}  // namespace semloop
