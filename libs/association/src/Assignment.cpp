#include <semloop/association/Assignment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "ShortestAugmentingPaths.h"

namespace semloop
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/** True when some pair is forbidden. */
bool validate(const Eigen::Ref<const CostMatrix>& cost, double gate)
{
	if (std::isnan(gate) || gate == -kInfinity)
		throw std::invalid_argument(
			"solveAssignment: the gate is " + std::to_string(gate) + "; use a number or +infinity");
	bool forbidden = false;
	for (Eigen::Index row = 0; row < cost.rows(); ++row)
	{
		const double* costs = cost.data() + row * cost.outerStride();
		bool usable = true;
		for (Eigen::Index column = 0; column < cost.cols(); ++column)
		{
			usable &= costs[column] > -kInfinity;  // false for NaN
			forbidden |= costs[column] == kInfinity;
		}
		if (usable) continue;
		const auto* bad = std::find_if(
			costs, costs + cost.cols(), [](double value) { return !(value > -kInfinity); });
		throw std::invalid_argument(
			"solveAssignment: cost(" + std::to_string(row) + ", " + std::to_string(bad - costs) +
			") is " + std::to_string(*bad) + "; use a number, or +infinity to forbid the pair");
	}
	return forbidden;
}

/** rows <= columns. */
std::vector<std::size_t> columnsOfRows(
	const Eigen::Ref<const CostMatrix>& cost, double gate, bool forbidden)
{
	if (gate < kInfinity) return ShortestAugmentingPaths<double>(cost, gate, gate).solve();
	if (!forbidden) return ShortestAugmentingPaths<double>(cost, kInfinity, kInfinity).solve();
	return ShortestAugmentingPaths<Lexicographic>(
			   cost, std::numeric_limits<double>::max(), Lexicographic{1.0, 0.0})
		.solve();
}
}  // namespace

AssignmentResult solveAssignment(const Eigen::Ref<const CostMatrix>& cost, double gate)
{
	const bool forbidden = validate(cost, gate);
	AssignmentResult result;
	if (cost.size() == 0) return result;

	if (cost.rows() <= cost.cols())
	{
		const auto columns = columnsOfRows(cost, gate, forbidden);
		for (std::size_t row = 0; row < columns.size(); ++row)
			if (columns[row] != kNone) result.matches.emplace_back(row, columns[row]);
	}
	else
	{
		const CostMatrix transposed = cost.transpose();
		const auto rows = columnsOfRows(transposed, gate, forbidden);
		for (std::size_t column = 0; column < rows.size(); ++column)
			if (rows[column] != kNone) result.matches.emplace_back(rows[column], column);
		std::sort(result.matches.begin(), result.matches.end());
	}
	for (const auto& [row, column] : result.matches) result.cost += cost(row, column);
	return result;
}

}  // namespace semloop
