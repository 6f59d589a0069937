#pragma once

#include <semloop/observations/LabelSet.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** p(l_k | l_j): how probably the network calls an object l_k (observed) when it is an l_j (true);
 *  each column of a true label sums to 1. Eq. (3). */
class ConfusionMatrix
{
   public:
	ConfusionMatrix() = default;
	/** Identity smoothed: p = correct on the diagonal, the rest spread evenly. */
	ConfusionMatrix(LabelSet labels, double correct);
	/** Learned from (true, observed) label pairs; each count starts at `smoothing` off the diagonal and
	 *  10 * smoothing on it (Dirichlet prior), so that nothing is impossible. */
	static ConfusionMatrix learn(
		LabelSet labels, const std::vector<std::pair<uint32_t, uint32_t>>& trueObserved,
		double smoothing = 0.1);

	/** JSON: {"format": "semloop.confusion/1", "labels": [...], "p": [[row of observed given true], ...]};
	 *  p[j][k] = p(l_k | l_j). Throws InputError naming file and entry. */
	static ConfusionMatrix load(const std::string& path);
	void save(const std::string& path) const;

	const LabelSet& labels() const { return labels_; }
	double probability(uint32_t observed, uint32_t truth) const { return p_(truth, observed); }

	/** Expected p(l_k | l_j) of two label distributions: sum over k, j of s_k s_j p(l_k | l_j), in
	 *  [0, 1]. The rest of a distribution up to 1 is unknown and agrees with nothing. */
	double agreement(const LabelScores& observed, const LabelScores& truth) const;

   private:
	LabelSet labels_;
	Eigen::MatrixXf p_;  //!< row: true, column: observed
};

}  // namespace semloop
