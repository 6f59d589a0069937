#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>
#include <Eigen/Core>

#include <algorithm>

#include "RewardMatrix.h"

namespace semloop
{
namespace
{
constexpr Eigen::Index kKrylovSize = 12;

using Product = Spectra::SparseSymMatProd<double, Eigen::Upper, Eigen::RowMajor>;

/** One step from the vector of ones: the sum of each row, a good guess of the Perron vector. */
Eigen::VectorXd rowSums(const RewardMatrix::Matrix& upper)
{
	return upper.selfadjointView<Eigen::Upper>() * Eigen::VectorXd::Ones(upper.rows());
}

/** Adding 1 to every eigenvalue changes no eigenvector and keeps a -lambda of equal size from
 *  stopping the iteration. */
Eigen::VectorXd powerIteration(
	const RewardMatrix::Matrix& upper, double tolerance, int maxIterations)
{
	Eigen::VectorXd x = rowSums(upper).normalized();
	for (int i = 0; i < std::max(maxIterations, 100); ++i)
	{
		const Eigen::VectorXd next = (x + upper.selfadjointView<Eigen::Upper>() * x).normalized();
		const bool done = (next - x).norm() < tolerance;
		x = next;
		if (done) break;
	}
	return x;
}
}  // namespace

Eigen::VectorXd principalEigenvector(
	const RewardMatrix::Matrix& upper, double tolerance, int maxIterations)
{
	if (upper.rows() == 0) return {};
	if (upper.rows() < 3) return powerIteration(upper, tolerance, maxIterations);

	Product product(upper);
	Spectra::SymEigsSolver<Product> solver(product, 1, std::min(kKrylovSize, upper.rows()));
	const Eigen::VectorXd start = rowSums(upper);
	solver.init(start.data());
	solver.compute(Spectra::SortRule::LargestAlge, maxIterations, tolerance);
	if (solver.info() != Spectra::CompInfo::Successful)
		return powerIteration(upper, tolerance, maxIterations);
	// The sign of an eigenvector is free; by Perron and Frobenius all entries have the same.
	return solver.eigenvectors(1).col(0).cwiseAbs();
}

}  // namespace semloop
