#pragma once

#include <semloop/association/Assignment.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace semloop
{
/** No column. */
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/** Pairs given up first, cost second: "as many pairs as possible, at the least cost". */
struct Lexicographic
{
	double givenUp = 0.0;
	double cost = 0.0;
};

inline Lexicographic operator+(Lexicographic a, Lexicographic b)
{
	return {a.givenUp + b.givenUp, a.cost + b.cost};
}

inline Lexicographic operator-(Lexicographic a, Lexicographic b)
{
	return {a.givenUp - b.givenUp, a.cost - b.cost};
}

inline bool operator<(Lexicographic a, Lexicographic b)
{
	return a.givenUp < b.givenUp || (a.givenUp == b.givenUp && a.cost < b.cost);
}

/** What the search needs to know of a kind of cost. */
template <class Cost>
struct CostTraits;

template <>
struct CostTraits<double>
{
	static double of(double cost) { return cost; }
	static double unreachable() { return std::numeric_limits<double>::infinity(); }
};

template <>
struct CostTraits<Lexicographic>
{
	static Lexicographic of(double cost) { return {0.0, cost}; }
	static Lexicographic unreachable() { return {std::numeric_limits<double>::infinity(), 0.0}; }
};

/** Gives the rows their columns one after the other, each along the cheapest path of alternately
 *  new and given-up pairs that ends at a free column or at a row that then stays unmatched. Such a
 *  row has a private column at the price of `unmatched`, which is never stored.
 *
 *  A column once taken stays taken, and free columns have a potential of zero. So of the free
 *  columns only the cheapest of each row matters, and a search runs over the matched rows alone:
 *  its time does not depend on the number of columns. */
template <class Cost>
class ShortestAugmentingPaths
{
public:
	/** rows <= columns; a pair dearer than `dearest` is not to be made. */
	ShortestAugmentingPaths(
		const Eigen::Ref<const CostMatrix>& costs, double dearest, Cost unmatched)
		: costs_(costs),
		  dearest_(dearest),
		  unmatched_(unmatched),
		  columnOf_(costs.rows(), kNone),
		  cheapestFree_(costs.rows(), kUnknown),
		  parent_(costs.rows()),
		  taken_(costs.cols(), false),
		  rowPotential_(costs.rows()),
		  columnPotential_(costs.cols()),
		  distance_(costs.rows())
	{
		matched_.reserve(costs.rows());
	}

	/** The column of each row, or kNone. */
	std::vector<std::size_t> solve()
	{
		for (std::size_t row = 0; row < columnOf_.size(); ++row) matchRow(row);
		return std::move(columnOf_);
	}

private:
	using Traits = CostTraits<Cost>;
	static constexpr std::size_t kUnknown = kNone - 1;

	/** Where a path ends: at a free column, or (kNone) with its last row unmatched. */
	struct PathEnd
	{
		Cost distance = Traits::unreachable();
		std::size_t row = kNone;
		std::size_t column = kNone;
	};

	const double* rowCosts(std::size_t row) const
	{
		return costs_.data() + Eigen::Index(row) * costs_.outerStride();
	}

	/** Dijkstra over the matched rows, by reduced costs, then the path's pairs change over. */
	void matchRow(std::size_t start)
	{
		for (const auto row : matched_) distance_[row] = Traits::unreachable();
		PathEnd end;
		std::size_t row = start;
		Cost travelled{};
		std::size_t visited = 0;
		while (true)
		{
			considerEnds(row, travelled, end);
			const std::size_t next = relax(row, travelled, visited);
			if (next == kNone || !(distance_[matched_[next]] < end.distance)) break;
			std::swap(matched_[visited], matched_[next]);
			row = matched_[visited++];
			travelled = distance_[row];
		}
		if (end.row == kNone) return;  // only when sums of huge costs overflow
		updatePotentials(start, end.distance, visited);
		changeOver(start, end);
	}

	void considerEnds(std::size_t row, Cost travelled, PathEnd& end)
	{
		const Cost base = travelled - rowPotential_[row];
		const std::size_t column = cheapestFreeColumn(row);
		if (column != kNone)
		{
			const Cost distance = base + Traits::of(rowCosts(row)[column]);
			if (distance < end.distance) end = {distance, row, column};
		}
		if (base + unmatched_ < end.distance) end = {base + unmatched_, row, kNone};
	}

	/** Cached until it is taken: free columns only become fewer. */
	std::size_t cheapestFreeColumn(std::size_t row)
	{
		std::size_t& cheapest = cheapestFree_[row];
		if (cheapest == kNone || (cheapest != kUnknown && !taken_[cheapest])) return cheapest;
		const double* costs = rowCosts(row);
		double best = std::numeric_limits<double>::infinity();
		cheapest = kNone;
		for (std::size_t column = 0; column < taken_.size(); ++column)
			if (costs[column] < best && !taken_[column])
			{
				best = costs[column];
				cheapest = column;
			}
		if (best > dearest_) cheapest = kNone;  // unmatched is cheaper, but for rounding
		return cheapest;
	}

	/** Shortens the ways to the rows not visited yet; returns the place in matched_ of the nearest. */
	std::size_t relax(std::size_t from, Cost travelled, std::size_t visited)
	{
		const double* costs = rowCosts(from);
		const Cost base = travelled - rowPotential_[from];
		std::size_t nearest = kNone;
		Cost shortest = Traits::unreachable();
		for (std::size_t i = visited; i < matched_.size(); ++i)
		{
			const std::size_t row = matched_[i];
			const std::size_t column = columnOf_[row];
			if (costs[column] <= dearest_)
			{
				const Cost distance = base + (Traits::of(costs[column]) - columnPotential_[column]);
				if (distance < distance_[row])
				{
					distance_[row] = distance;
					parent_[row] = from;
				}
			}
			if (distance_[row] < shortest)
			{
				shortest = distance_[row];
				nearest = i;
			}
		}
		return nearest;
	}

	void updatePotentials(std::size_t start, Cost length, std::size_t visited)
	{
		rowPotential_[start] = rowPotential_[start] + length;
		for (std::size_t i = 0; i < visited; ++i)
		{
			const std::size_t row = matched_[i];
			const Cost change = length - distance_[row];
			rowPotential_[row] = rowPotential_[row] + change;
			columnPotential_[columnOf_[row]] = columnPotential_[columnOf_[row]] - change;
		}
	}

	void changeOver(std::size_t start, const PathEnd& end)
	{
		std::size_t column = end.column;
		if (column != kNone)
		{
			taken_[column] = true;
			matched_.push_back(start);
		}
		else if (end.row != start)
			*std::find(matched_.begin(), matched_.end(), end.row) = start;
		for (std::size_t row = end.row; row != start; row = parent_[row])
			std::swap(columnOf_[row], column);
		columnOf_[start] = column;
	}

	const Eigen::Ref<const CostMatrix>& costs_;
	const double dearest_;
	const Cost unmatched_;
	std::vector<std::size_t> columnOf_;      //!< of each row
	std::vector<std::size_t> cheapestFree_;  //!< of each row; kUnknown before the first look
	std::vector<std::size_t> parent_;  //!< of a matched row: the one before it on its shortest path
	std::vector<std::size_t> matched_;  //!< rows; during a search the visited ones come first
	std::vector<char> taken_;           //!< columns
	std::vector<Cost> rowPotential_, columnPotential_;
	std::vector<Cost> distance_;  //!< of the shortest known path to a matched row
};

}  // namespace semloop
