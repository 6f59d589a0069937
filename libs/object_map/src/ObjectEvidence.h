#pragma once

#include <semloop/observations/LabelSet.h>

#include <vector>

namespace semloop
{
/** Mean of two distributions that stand for weightA and weightB observations (> 0 together); highest
 *  first, ties by label; what falls under 0.005 is dropped, but never the best. */
LabelScores averageLabels(
	const LabelScores& a, double weightA, const LabelScores& b, double weightB);

/** sum over l of min(a_l, b_l), in [0, 1]. */
double labelOverlap(const LabelScores& a, const LabelScores& b);

/** Adds embeddings (unit length); while there are more than maximum, one of the two most similar
 *  goes: the one that the others represent better. */
void addEmbeddings(
	std::vector<std::vector<float>>& set, const std::vector<std::vector<float>>& added,
	int maximum);

/** p after this much more evidence in log-odds; stays inside what further evidence can change. */
double updatedExistence(double p, double logOdds);

constexpr double kHitLogOdds = 0.4;
constexpr double kSeenThroughLogOdds = -1.2;

}  // namespace semloop
