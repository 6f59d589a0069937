#pragma once

#include <semloop/observations/LabelSet.h>
#include <semloop/simulation/SimulatedDetector.h>

#include <vector>

#include "Random.h"

namespace semloop
{
/** What a network calls things. */
class SimulatedLabels
{
public:
	/** Throws UsageError for an entry of options.confusions that is not "true>observed:probability" of
	 *  two labels in the set, or when those of a label sum to more than 1. */
	SimulatedLabels(const LabelSet& labels, const SimulatedDetectorOptions& options);

	/** Two labels at most, summing to less than 1. `clarity` in [0, 1] raises the leader's score when
	 *  it is the truth: about 0.7 to 0.95; one that leads wrongly has 0.45 to 0.65, then comes the
	 *  truth. */
	LabelScores draw(uint32_t truth, double clarity, RandomStream& random) const;

private:
	uint32_t otherThan(uint32_t label, RandomStream& random) const;
	uint32_t leader(uint32_t truth, RandomStream& random) const;

	uint32_t count_ = 0;
	double rate_ = 0;
	std::vector<LabelScores> confused_;  // by true label; empty: any other at rate_
};

}  // namespace semloop
