#include <gtest/gtest.h>
#include <semloop/association/Assignment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using semloop::AssignmentResult;
using semloop::CostMatrix;
using semloop::solveAssignment;

namespace
{
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CostMatrix matrix(int rows, int columns, const std::vector<double>& values)
{
	return Eigen::Map<const CostMatrix>(values.data(), rows, columns);
}

/** Number of pairs and their cost. */
struct Outcome
{
	int pairs = 0;
	double cost = 0;
};

/** Tries everything: every row takes each free column or none. */
template <class Better>
void search(
	const CostMatrix& cost, int row, std::vector<bool>& taken, Outcome current, Outcome& best,
	const Better& better)
{
	if (row == cost.rows())
	{
		if (better(current, best)) best = current;
		return;
	}
	search(cost, row + 1, taken, current, best, better);
	for (int column = 0; column < cost.cols(); ++column)
	{
		if (taken[column] || std::isinf(cost(row, column))) continue;
		taken[column] = true;
		search(
			cost, row + 1, taken, {current.pairs + 1, current.cost + cost(row, column)}, best,
			better);
		taken[column] = false;
	}
}

Outcome bruteForce(const CostMatrix& cost, double gate)
{
	const int smaller = int(std::min(cost.rows(), cost.cols()));
	const auto better = [&](const Outcome& a, const Outcome& b)
	{
		if (std::isinf(gate)) return a.pairs > b.pairs || (a.pairs == b.pairs && a.cost < b.cost);
		return a.cost + gate * (smaller - a.pairs) < b.cost + gate * (smaller - b.pairs);
	};
	std::vector<bool> taken(cost.cols(), false);
	Outcome best;  // nothing matched
	search(cost, 0, taken, {}, best, better);
	return best;
}

void expectValid(const CostMatrix& cost, double gate, const AssignmentResult& result)
{
	std::vector<bool> columnTaken(cost.cols(), false);
	double sum = 0;
	for (std::size_t i = 0; i < result.matches.size(); ++i)
	{
		const auto [row, column] = result.matches[i];
		ASSERT_LT(row, std::size_t(cost.rows()));
		ASSERT_LT(column, std::size_t(cost.cols()));
		EXPECT_TRUE(i == 0 || result.matches[i - 1].first < row);
		EXPECT_FALSE(columnTaken[column]);
		columnTaken[column] = true;
		EXPECT_LE(cost(row, column), gate);
		EXPECT_FALSE(std::isinf(cost(row, column)));
		sum += cost(row, column);
	}
	EXPECT_DOUBLE_EQ(result.cost, sum);
}

void expectOptimal(const CostMatrix& cost, double gate)
{
	SCOPED_TRACE(testing::Message() << "gate " << gate << ", cost\n" << cost);
	const auto result = solveAssignment(cost, gate);
	expectValid(cost, gate, result);
	const auto best = bruteForce(cost, gate);
	const int smaller = int(std::min(cost.rows(), cost.cols()));
	const int pairs = int(result.matches.size());
	if (std::isinf(gate))
	{
		EXPECT_EQ(pairs, best.pairs);
		EXPECT_NEAR(result.cost, best.cost, 1e-12);
	}
	else
		EXPECT_NEAR(
			result.cost + gate * (smaller - pairs), best.cost + gate * (smaller - best.pairs),
			1e-12);
}

/** Calls check with `repetitions` matrices of every size from 0 x 0 to 5 x 5. */
template <class Entry, class Check>
void forAllSmallSizes(int repetitions, const Entry& entry, const Check& check)
{
	std::mt19937 random(7);
	for (int rows = 0; rows <= 5; ++rows)
		for (int columns = 0; columns <= 5; ++columns)
			for (int i = 0; i < repetitions; ++i)
			{
				CostMatrix cost(rows, columns);
				for (Eigen::Index k = 0; k < cost.size(); ++k) cost.data()[k] = entry(random);
				check(cost, random);
			}
}

double uniform(std::mt19937& random, double low, double high)
{
	return std::uniform_real_distribution<double>(low, high)(random);
}
}  // namespace

TEST(Assignment, PrefersTheCheaperTotalToTheCheapestPair)
{
	// Taking 1 first leaves 9: 10 in all. The other way 2 + 3 = 5.
	const auto result = solveAssignment(matrix(2, 2, {1, 2, 3, 9}));
	EXPECT_EQ(result.matches, (Pairs{{0, 1}, {1, 0}}));
	EXPECT_DOUBLE_EQ(result.cost, 5);
}

TEST(Assignment, OfNothingIsEmpty)
{
	for (const auto& [rows, columns] : {std::pair(0, 0), std::pair(0, 4), std::pair(4, 0)})
	{
		const auto result = solveAssignment(CostMatrix(rows, columns), 1.0);
		EXPECT_TRUE(result.matches.empty());
		EXPECT_EQ(result.cost, 0);
	}
}

TEST(Assignment, MatchesEveryRowOfAWideMatrixAndEveryColumnOfATallOne)
{
	const auto wide = matrix(2, 3, {5, 1, 7, 4, 2, 9});
	EXPECT_EQ(solveAssignment(wide).matches, (Pairs{{0, 1}, {1, 0}}));
	EXPECT_EQ(solveAssignment(wide.transpose()).matches, (Pairs{{0, 1}, {1, 0}}));
	EXPECT_DOUBLE_EQ(solveAssignment(wide.transpose()).cost, 5);
}

TEST(Assignment, KeepsRowsUnmatchedAboveTheGate)
{
	const auto cost = matrix(2, 2, {0.3, 0.9, 0.95, 0.85});
	EXPECT_EQ(solveAssignment(cost, 0.8).matches, (Pairs{{0, 0}}));
	EXPECT_EQ(solveAssignment(cost, 0.2).matches, Pairs{});
}

TEST(Assignment, LeavesARowUnmatchedWhenThatIsCheaperThanTheDetourOfTheOthers)
{
	// Both want column 0: matching both costs 0.1 + 0.75 = 0.85, one and the gate 0.1 + 0.7.
	const auto cost = matrix(2, 2, {0.1, 0.75, 0.2, 0.9});
	const auto result = solveAssignment(cost, 0.7);
	EXPECT_EQ(result.matches, (Pairs{{0, 0}}));
}

TEST(Assignment, GivesUpAPairMadeEarlierWhenANewRowNeedsItsColumnMore)
{
	// Row 0 takes column 0 first; row 1 has nothing else, and row 0 may stay unmatched for 1.
	const auto result = solveAssignment(matrix(2, 2, {0.9, kInfinity, 0.1, kInfinity}), 1.0);
	EXPECT_EQ(result.matches, (Pairs{{1, 0}}));
}

TEST(Assignment, NeverMakesAForbiddenPair)
{
	const auto result = solveAssignment(matrix(2, 2, {1, kInfinity, kInfinity, kInfinity}));
	EXPECT_EQ(result.matches, (Pairs{{0, 0}}));
	EXPECT_DOUBLE_EQ(result.cost, 1);
	EXPECT_TRUE(solveAssignment(CostMatrix::Constant(3, 4, kInfinity)).matches.empty());
	EXPECT_TRUE(solveAssignment(CostMatrix::Constant(3, 4, kInfinity), 5).matches.empty());
}

TEST(Assignment, MakesAsManyPairsAsPossibleHoweverDear)
{
	// The cheap pair (0, 0) would leave row 1 without a partner.
	const auto cost = matrix(2, 2, {0, 1e12, 1e12, kInfinity});
	EXPECT_EQ(solveAssignment(cost).matches, (Pairs{{0, 1}, {1, 0}}));
}

TEST(Assignment, ChoosesTheCheapestOfTheLargestMatchingsWhenNotAllRowsFit)
{
	// Three rows share one column: the last is the cheapest, and -4 wins over 2 and 5.
	const auto cost =
		matrix(3, 3, {5, kInfinity, kInfinity, 2, kInfinity, kInfinity, -4, kInfinity, kInfinity});
	EXPECT_EQ(solveAssignment(cost).matches, (Pairs{{2, 0}}));
}

TEST(Assignment, IsOptimalForAllSmallSizes)
{
	forAllSmallSizes(
		60, [](std::mt19937& random) { return uniform(random, -1, 1); },
		[](const CostMatrix& cost, std::mt19937& random)
		{
			expectOptimal(cost, kInfinity);
			expectOptimal(cost, uniform(random, -1.2, 1.2));
		});
}

TEST(Assignment, IsOptimalForAllSmallSizesWithForbiddenPairs)
{
	forAllSmallSizes(
		100,
		[](std::mt19937& random)
		{ return uniform(random, 0, 1) < 0.55 ? kInfinity : uniform(random, -3, 3); },
		[](const CostMatrix& cost, std::mt19937& random)
		{
			expectOptimal(cost, kInfinity);
			expectOptimal(cost, uniform(random, -3, 3));
		});
}

TEST(Assignment, IsOptimalForAllSmallSizesWithTies)
{
	forAllSmallSizes(
		60,
		[](std::mt19937& random)
		{
			const int value = std::uniform_int_distribution<int>(-1, 3)(random);
			return value == 3 ? kInfinity : double(value);
		},
		[](const CostMatrix& cost, std::mt19937&)
		{
			expectOptimal(cost, kInfinity);
			for (const double gate : {-1.0, 0.0, 1.0, 2.0}) expectOptimal(cost, gate);
		});
}

TEST(Assignment, FindsAPlantedSolutionInALargeMatrix)
{
	// Potentials u + v make the planted pairs the only tight ones, so they are the optimum.
	constexpr int rows = 60, columns = 200;
	std::mt19937 random(3);
	Eigen::VectorXd u(rows);
	for (auto& value : u) value = uniform(random, -5, 5);
	std::vector<std::size_t> partner(columns);
	for (int i = 0; i < columns; ++i) partner[i] = i;
	std::shuffle(partner.begin(), partner.end(), random);
	Eigen::VectorXd v = Eigen::VectorXd::Zero(columns);  // must be 0 where no row is matched
	for (int row = 0; row < rows; ++row) v[partner[row]] = -uniform(random, 0, 5);
	CostMatrix cost(rows, columns);
	for (int row = 0; row < rows; ++row)
		for (int column = 0; column < columns; ++column)
			cost(row, column) =
				u[row] + v[column] +
				(partner[row] == std::size_t(column) ? 0 : uniform(random, 0.01, 2));

	Pairs expected;
	for (int row = 0; row < rows; ++row) expected.emplace_back(row, partner[row]);
	EXPECT_EQ(solveAssignment(cost).matches, expected);
}

TEST(Assignment, DoesNotDependOnTheOrderOfRowsAndColumns)
{
	std::mt19937 random(5);
	CostMatrix cost(12, 30);
	for (Eigen::Index k = 0; k < cost.size(); ++k) cost.data()[k] = uniform(random, 0, 1);
	const CostMatrix reversed = cost.reverse();
	Pairs expected;
	for (const auto& [row, column] : solveAssignment(reversed, 0.1).matches)
		expected.emplace_back(11 - row, 29 - column);
	std::sort(expected.begin(), expected.end());
	EXPECT_EQ(solveAssignment(cost, 0.1).matches, expected);
}

TEST(Assignment, ReadsABlockOfALargerMatrix)
{
	const auto large = matrix(3, 4, {9, 9, 9, 9, 9, 2, 1, 9, 9, 1, 5, 9});
	const auto result = solveAssignment(large.block(1, 1, 2, 2));
	EXPECT_EQ(result.matches, (Pairs{{0, 1}, {1, 0}}));
	EXPECT_DOUBLE_EQ(result.cost, 2);
}

TEST(Assignment, SurvivesCostsWhoseSumsOverflow)
{
	constexpr double huge = std::numeric_limits<double>::max();
	const auto cost = matrix(3, 3, {huge, -huge, huge, -huge, huge, -huge, huge, huge, -huge});
	EXPECT_LE(solveAssignment(cost).matches.size(), 3u);
	EXPECT_LE(solveAssignment(cost, huge).matches.size(), 3u);
}

TEST(Assignment, NamesTheEntryThatIsNotANumber)
{
	const auto message = [](double bad)
	{
		auto cost = matrix(2, 3, {1, 2, 3, 4, 5, 6});
		cost(1, 2) = bad;
		try
		{
			solveAssignment(cost);
		}
		catch (const std::invalid_argument& e)
		{
			return std::string(e.what());
		}
		return std::string();
	};
	EXPECT_NE(message(std::nan("")).find("cost(1, 2)"), std::string::npos);
	EXPECT_NE(message(-kInfinity).find("cost(1, 2)"), std::string::npos);
	EXPECT_THROW(solveAssignment(matrix(1, 1, {1}), std::nan("")), std::invalid_argument);
	EXPECT_THROW(solveAssignment(matrix(1, 1, {1}), -kInfinity), std::invalid_argument);
}
