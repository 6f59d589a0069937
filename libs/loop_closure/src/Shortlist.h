#pragma once

#include <mrpt/core/bits_math.h>
#include <semloop/loop_closure/YawPose.h>

#include <algorithm>
#include <vector>

#include "MatchCandidates.h"

namespace semloop
{
struct Proposal
{
	YawPose pose;
	double support = 0;
};

/** The best few poses that differ. */
class Shortlist
{
public:
	explicit Shortlist(const MatchCandidates& candidates) : candidates_(candidates) {}

	/** What does not reach this is not worth adding. */
	double least() const
	{
		if (proposals_.empty()) return 0;
		const double best = proposals_.front().support;
		const double hopeless = best - std::max(kHopeless, 0.5 * best);
		return proposals_.size() < kHypotheses ? hopeless
											   : std::max(hopeless, proposals_.back().support);
	}

	void add(const Proposal& proposal)
	{
		for (auto other = proposals_.begin(); other != proposals_.end(); ++other)
			if (squaredDistance(other->pose, proposal.pose) < kSamePose * kSamePose)
			{
				if (other->support >= proposal.support) return;
				proposals_.erase(other);
				break;
			}
		const auto place = std::upper_bound(
			proposals_.begin(), proposals_.end(), proposal.support,
			[](double support, const Proposal& other) { return support > other.support; });
		proposals_.insert(place, proposal);
		if (proposals_.size() > kHypotheses) proposals_.pop_back();
		while (proposals_.back().support < least()) proposals_.pop_back();
	}

	/** The refinement of the best leads to the same place from there. */
	bool isAtBest(const YawPose& pose) const
	{
		return !proposals_.empty() &&
			   squaredDistance(proposals_.front().pose, pose) < kNearBest * kNearBest;
	}

	const std::vector<Proposal>& proposals() const { return proposals_; }

	/** Mean over the query's centres. */
	double squaredDistance(const YawPose& a, const YawPose& b) const
	{
		const double cosine = a.cosine * b.cosine + a.sine * b.sine;
		return (a * candidates_.centroid() - b * candidates_.centroid()).sqrNorm() +
			   2 * (1 - cosine) * candidates_.spread();
	}

private:
	// That are refined.
	static constexpr std::size_t kHypotheses = 12;
	// Evidence behind the best from where no rival comes back: the refinement adds half of it at most.
	static constexpr double kHopeless = 40;
	static constexpr double kNearBest = 0.1;  // to the best, not worth a look [m]
	static constexpr double kSamePose = 0.4;  // poses so near lead to one place [m]

	const MatchCandidates& candidates_;
	std::vector<Proposal> proposals_;
};

}  // namespace semloop
