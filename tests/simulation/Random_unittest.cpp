#include "../../libs/simulation/src/Random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

using namespace semloop;

namespace
{
double normalProbability(double x)
{
	return 0.5 * std::erfc(-x / std::sqrt(2.0));
}
}  // namespace

TEST(Random, AStreamOfKeyZeroGivesThePublishedNumbersOfSplitMix64)
{
	RandomStream random(0);
	EXPECT_EQ(random.bits(), 0xE220A8397B1DCDAFU);
	EXPECT_EQ(random.bits(), 0x6E789E6AA1B965F4U);
	EXPECT_EQ(random.bits(), 0x06C45D188009454FU);
}

TEST(Random, KeysInAnotherOrderOrNumberGiveAnotherHash)
{
	const std::set<uint64_t> hashes{
		hashed(1),
		hashed(1, 0),
		hashed(1, 2),
		hashed(2, 1),
		hashed(1, 2, 0),
		hashed(1, 0, 2),
		hashed(0, 1),
		hashedFor("miss", 1, 2),
		hashedFor("split", 1, 2)};
	EXPECT_EQ(hashes.size(), 9u);
}

TEST(Random, UniformNumbersFillTheUnitIntervalEvenly)
{
	constexpr int kCount = 100000;
	double sum = 0, squares = 0;
	RandomStream random(7);
	for (int i = 0; i < kCount; i++)
	{
		const double u = random.uniform();
		ASSERT_GE(u, 0);
		ASSERT_LT(u, 1);
		sum += u;
		squares += u * u;
	}
	// Three standard errors: 3 sqrt(1 / 12 / n) and 3 sqrt(4 / 45 / n).
	EXPECT_NEAR(sum / kCount, 0.5, 0.0028);
	EXPECT_NEAR(squares / kCount, 1.0 / 3, 0.0029);
}

TEST(Random, TheQuantileInvertsTheNormalDistribution)
{
	EXPECT_EQ(normalQuantile(0.5), 0);
	EXPECT_NEAR(normalQuantile(0.975), 1.959964, 1e-6);
	for (const double x : {-8.0, -6.0, -3.0, -1.0, -0.2, 0.3, 1.4, 2.0, 5.0})
		EXPECT_NEAR(normalQuantile(normalProbability(x)), x, 1e-6) << x;
}

TEST(Random, TheTableHasTheMomentsOfTheNormalDistribution)
{
	const NormalTable table;
	constexpr uint64_t kCount = uint64_t(1) << NormalTable::kBits;
	double sum = 0, squares = 0, fourths = 0;
	for (uint64_t bits = 0; bits < kCount; bits++)
	{
		const double x = table(bits);
		sum += x;
		squares += x * x;
		fourths += x * x * x * x;
	}
	EXPECT_NEAR(sum / kCount, 0, 1e-7);
	EXPECT_NEAR(squares / kCount, 1, 0.001);
	EXPECT_NEAR(fourths / kCount, 3, 0.03);
}

TEST(Random, TheTablesDistributionIsThatOfTheNormalUpToThreeAndAHalfSigma)
{
	const NormalTable table;
	constexpr uint64_t kCount = uint64_t(1) << NormalTable::kBits;
	for (uint64_t bits = 0; bits < kCount; bits += 97)
	{
		const double x = table(bits);
		if (std::abs(x) > 3.49) continue;
		ASSERT_NEAR(normalProbability(x), (double(bits) + 0.5) / kCount, 2e-5) << x;
	}
	EXPECT_NEAR(table(kCount - 1), 4, 0.01);
}

TEST(Random, ThreeNumbersOfOneHashAreIndependent)
{
	constexpr int kCount = 100000;
	double ab = 0, bc = 0;
	RandomStream random(3);
	for (int i = 0; i < kCount; i++)
	{
		const uint64_t bits = random.bits();
		const double a = normalTable()(bits), b = normalTable()(bits >> NormalTable::kBits),
					 c = normalTable()(bits >> (2 * NormalTable::kBits));
		ab += a * b;
		bc += b * c;
	}
	EXPECT_NEAR(ab / kCount, 0, 3 / std::sqrt(double(kCount)));
	EXPECT_NEAR(bc / kCount, 0, 3 / std::sqrt(double(kCount)));
}

TEST(Random, PoissonEventsHaveTheirMeanAndVariance)
{
	constexpr int kCount = 20000;
	double sum = 0, squares = 0;
	for (int i = 0; i < kCount; i++)
	{
		const int events = RandomStream(hashed(11, i)).poisson(2.0);
		sum += events;
		squares += double(events) * events;
	}
	const double mean = sum / kCount;
	EXPECT_NEAR(mean, 2.0, 0.03);  // three standard errors
	EXPECT_NEAR(squares / kCount - mean * mean, 2.0, 0.1);
	EXPECT_EQ(RandomStream(1).poisson(0), 0);
}
