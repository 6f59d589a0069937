#pragma once

#include <semloop/observations/LabelSet.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** p(l_k | l_j): how probably the network calls an object l_k (observed) when it is an l_j (true);
 *  over all l_k it sums to 1. Eq. (3). */
class ConfusionMatrix
{
public:
	/** Of no labels: knows nothing that could agree. */
	ConfusionMatrix() = default;
	/** Identity smoothed: p = correct on the diagonal, the rest spread evenly (a single label is
	 *  always right). Throws std::invalid_argument unless correct is in [0, 1]. */
	ConfusionMatrix(LabelSet labels, double correct);
	/** Learned from (true, observed) label pairs; each count starts at `smoothing` off the diagonal and
	 *  10 * smoothing on it (Dirichlet prior), so that nothing is impossible. Throws InputError naming
	 *  a pair with a label that is not in the set, std::invalid_argument unless smoothing > 0. */
	static ConfusionMatrix learn(
		LabelSet labels, const std::vector<std::pair<uint32_t, uint32_t>>& trueObserved,
		double smoothing = 0.1);
	/** Same, from a table of how often each pair was seen (row: true, column: observed). Throws
	 *  std::invalid_argument unless it is labels x labels of numbers >= 0. */
	static ConfusionMatrix learnFromCounts(
		LabelSet labels, const Eigen::MatrixXd& counts, double smoothing = 0.1);

	/** JSON: {"format": "semloop.confusion/1", "labels": [...], "p": [[row of observed given true], ...]};
	 *  p[j][k] = p(l_k | l_j), each row summing to 1 within 0.001. Throws InputError naming file and
	 *  entry. */
	static ConfusionMatrix load(const std::string& path);
	void save(const std::string& path) const;

	const LabelSet& labels() const { return labels_; }
	/** p(l_k = observed | l_j = truth). Throws InputError when a label is not in the set. */
	double probability(uint32_t observed, uint32_t truth) const;

	/** Expected p(l_k | l_j) of two label distributions: sum over k, j of s_k s_j p(l_k | l_j), in
	 *  [0, 1]. The rest of a distribution up to 1 is unknown and agrees with nothing.
	 *  Throws InputError when a label is not in the set. */
	double agreement(const LabelScores& observed, const LabelScores& truth) const;

private:
	ConfusionMatrix(LabelSet labels, Eigen::MatrixXf p);
	void requireLabel(uint32_t label) const;

	LabelSet labels_;
	Eigen::MatrixXf p_;  //!< row: true, column: observed
};

}  // namespace semloop
