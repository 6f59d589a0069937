#pragma once

#include <semloop/loop_closure/GraphMatcher.h>
#include <Eigen/SparseCore>

#include <vector>

namespace semloop
{
/** S of Eq. (4) over the label-compatible pairs only. */
struct RewardMatrix
{
	using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

	std::vector<Match> candidates;  //!< row i of S is candidates[i]; by query vertex
	Matrix upper;                   //!< upper triangle with the diagonal, rows in compressed form
};

/** Throws InputError when S would have more than maxEntries off the diagonal. */
RewardMatrix buildRewardMatrix(
	const SemanticGraph& query, const SemanticGraph& target, double mu, int maxEntries);

/** The eigenvector of the largest eigenvalue of a symmetric non-negative matrix: unit length,
 *  entries >= 0. Lanczos (Spectra); power iteration when that does not converge or n < 3. */
Eigen::VectorXd principalEigenvector(
	const RewardMatrix::Matrix& upper, double tolerance, int maxIterations);

}  // namespace semloop
