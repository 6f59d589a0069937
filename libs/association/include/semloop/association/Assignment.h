#pragma once

#include <Eigen/Core>
#include <limits>
#include <utility>
#include <vector>

namespace semloop
{
using CostMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct AssignmentResult
{
	std::vector<std::pair<std::size_t, std::size_t>> matches;  //!< (row, column), by row
	double cost = 0.0;                                         //!< sum over the matches
};

/** Linear assignment, Eq. (1): min sum A(j,k) L(j,k), every row and every column at most once.
 *
 *  Without a gate as many pairs as possible are matched (min(rows, columns) when no entry is
 *  forbidden), at the least total cost among those. With a finite gate a row may stay unmatched at
 *  the cost of the gate: the result minimises sum(matched costs) + gate * (unmatched of the smaller
 *  side), so no pair dearer than the gate is ever matched (Sec. III-B: "surpass a certain threshold").
 *
 *  +infinity forbids a pair; NaN and -infinity throw std::invalid_argument naming the entry. Costs
 *  may be negative. Either dimension may be 0. Ties are broken the same way every time.
 *  O(m^2 n), m the smaller side: shortest augmenting paths (D. Crouse, "On implementing 2D
 *  rectangular assignment algorithms", IEEE TAES 52(4), 2016). */
AssignmentResult solveAssignment(
	const Eigen::Ref<const CostMatrix>& cost,
	double gate = std::numeric_limits<double>::infinity());

}  // namespace semloop
