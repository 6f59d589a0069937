#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/TrajectoryError.h>

#include <cmath>
#include <limits>

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

constexpr double kPi = 3.14159265358979323846;

mrpt::Clock::time_point at(double seconds)
{
	return mrpt::Clock::fromDouble(1000 + seconds);
}

/** One pose a tick of period seconds. */
Trajectory trajectoryOf(const std::vector<CPose3D>& poses, double period = 1.0)
{
	Trajectory result;
	for (std::size_t i = 0; i < poses.size(); i++)
		result.push_back({at(double(i) * period), poses[i]});
	return result;
}

CPose3D position(double x, double y, double z)
{
	return CPose3D(x, y, z, 0, 0, 0);
}

/** A helix: positions that span space, rotations about all axes. */
std::vector<CPose3D> helix(int n)
{
	std::vector<CPose3D> poses;
	for (int i = 0; i < n; i++)
	{
		const double a = 0.2 * i;
		poses.emplace_back(std::cos(a), std::sin(a), 0.1 * i, a, 0.3 * std::sin(a), 0.1 * a);
	}
	return poses;
}

std::vector<PosePair> pairsOf(
	const std::vector<CPose3D>& estimate, const std::vector<CPose3D>& truth, double period = 1.0)
{
	return associateByTime(trajectoryOf(estimate, period), trajectoryOf(truth, period));
}

TEST(AssociateByTime, TakesTheNearestTruePoseWithinTheLimitAndDropsTheOthers)
{
	const Trajectory estimate{{at(0), {}}, {at(1), {}}, {at(2), {}}};
	const Trajectory truth{
		{at(0.015), position(1, 0, 0)},
		{at(0.99), position(2, 0, 0)},
		{at(1.005), position(3, 0, 0)},
		{at(2.5), position(4, 0, 0)}};
	const auto pairs = associateByTime(estimate, truth, 0.02);
	ASSERT_EQ(pairs.size(), 2u);
	EXPECT_EQ(pairs[0].truth.x(), 1);
	EXPECT_EQ(pairs[1].truth.x(), 3);
	EXPECT_NEAR(pairs[1].time, 1.0, 1e-6);
}

TEST(AssociateByTime, GivesATruePoseToTheCloserOfTwoEstimatesOnly)
{
	const Trajectory estimate{{at(0), position(1, 0, 0)}, {at(0.01), position(2, 0, 0)}};
	const Trajectory truth{{at(0.012), {}}};
	const auto pairs = associateByTime(estimate, truth, 0.02);
	ASSERT_EQ(pairs.size(), 1u);
	EXPECT_EQ(pairs[0].estimate.x(), 2);
}

TEST(AssociateByTime, GivesNoPairForEmptyOrDisjointTrajectories)
{
	const Trajectory some{{at(0), {}}};
	const Trajectory later{{at(5), {}}};
	EXPECT_TRUE(associateByTime({}, some).empty());
	EXPECT_TRUE(associateByTime(some, {}).empty());
	EXPECT_TRUE(associateByTime(some, later).empty());
}

TEST(ErrorSummary, HasTheTextbookStatistics)
{
	const auto odd = summarizeErrors({3, 1, 2});
	EXPECT_EQ(odd.count, 3u);
	EXPECT_DOUBLE_EQ(odd.mean, 2);
	EXPECT_DOUBLE_EQ(odd.median, 2);
	EXPECT_DOUBLE_EQ(odd.max, 3);
	EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(14.0 / 3));
	EXPECT_DOUBLE_EQ(summarizeErrors({4, 1, 2, 10}).median, 3);
}

TEST(ErrorSummary, OfNothingIsZeroAndNotNaN)
{
	const auto none = summarizeErrors({});
	EXPECT_EQ(none.count, 0u);
	EXPECT_EQ(none.rmse, 0);
	EXPECT_EQ(none.median, 0);
}

TEST(AbsoluteTrajectoryError, OfATurnedAndMovedCopyIsZeroAndTheMotionIsFound)
{
	const auto truth = helix(30);
	const CPose3D T_truth_estimate(1, -2, 0.5, 0.7, -0.4, 1.1);
	std::vector<CPose3D> estimate;
	for (const auto& pose : truth) estimate.push_back(pose - T_truth_estimate);

	const auto error = absoluteTrajectoryError(pairsOf(estimate, truth));
	EXPECT_LT(error.translation.max, 1e-12);
	EXPECT_LT((error.T_truth_estimate - T_truth_estimate).norm(), 1e-12);
	EXPECT_EQ(error.errors.size(), 30u);
}

TEST(AbsoluteTrajectoryError, WithoutAlignmentIsTheDistance)
{
	std::vector<CPose3D> estimate;
	for (const auto& pose : helix(5)) estimate.push_back(position(0.3, 0, 0.4) + pose);
	const auto error =
		absoluteTrajectoryError(pairsOf(estimate, helix(5)), TrajectoryAlignment::None);
	EXPECT_NEAR(error.translation.rmse, 0.5, 1e-12);
	EXPECT_NEAR(error.translation.median, 0.5, 1e-12);
	EXPECT_NEAR(error.translation.max, 0.5, 1e-12);
	EXPECT_EQ(error.T_truth_estimate.norm(), 0);
}

TEST(AbsoluteTrajectoryError, OfAnAlternatingOffsetIsItsAmplitude)
{
	// On a square, +-0.1 m along z in turn: no rigid motion makes that better.
	const std::vector<CPose3D> truth{
		position(0, 0, 0), position(1, 0, 0), position(1, 1, 0), position(0, 1, 0)};
	std::vector<CPose3D> estimate = truth;
	for (std::size_t i = 0; i < 4; i++) estimate[i].z(i % 2 ? -0.1 : 0.1);
	const auto error = absoluteTrajectoryError(pairsOf(estimate, truth));
	EXPECT_NEAR(error.translation.rmse, 0.1, 1e-9);
	EXPECT_NEAR(error.translation.mean, 0.1, 1e-9);
}

TEST(AbsoluteTrajectoryError, DoesNotCorrectScale)
{
	// Symmetric about the origin, twice as large: the ends are 1 m off.
	const std::vector<CPose3D> truth{
		position(-1, 0, 0), position(1, 0, 0), position(0, -1, 0), position(0, 1, 0)};
	std::vector<CPose3D> estimate;
	for (const auto& p : truth) estimate.push_back(position(2 * p.x(), 2 * p.y(), 0));
	EXPECT_NEAR(absoluteTrajectoryError(pairsOf(estimate, truth)).translation.rmse, 1.0, 1e-9);
}

TEST(AbsoluteTrajectoryError, DoesNotMirrorATrajectory)
{
	const auto truth = helix(20);
	std::vector<CPose3D> mirrored;
	for (const auto& p : truth) mirrored.push_back(position(-p.x(), p.y(), p.z()));
	EXPECT_GT(absoluteTrajectoryError(pairsOf(mirrored, truth)).translation.rmse, 0.05);
}

TEST(AbsoluteTrajectoryError, IsTheSameInEveryWorldAfterAlignment)
{
	auto estimate = helix(12);
	for (std::size_t i = 0; i < estimate.size(); i++) estimate[i].x_incr(0.05 * std::sin(3.0 * i));
	const double original = absoluteTrajectoryError(pairsOf(estimate, helix(12))).translation.rmse;
	for (auto& pose : estimate) pose = CPose3D(3, 1, -2, 2.5, 0.2, -0.9) + pose;
	const double moved = absoluteTrajectoryError(pairsOf(estimate, helix(12))).translation.rmse;
	EXPECT_GT(original, 0.01);
	EXPECT_NEAR(moved, original, 1e-12);
}

TEST(AbsoluteTrajectoryError, IsFiniteForACameraThatStandsStillOrMovesAlongALine)
{
	const std::vector<CPose3D> still(4, position(1, 2, 3));
	EXPECT_NEAR(absoluteTrajectoryError(pairsOf(still, still)).translation.max, 0, 1e-12);

	std::vector<CPose3D> alongX;
	std::vector<CPose3D> alongY;
	for (int i = 0; i < 5; i++)
	{
		alongX.push_back(position(i, 0, 0));
		alongY.push_back(position(0, i, 0));
	}
	EXPECT_NEAR(absoluteTrajectoryError(pairsOf(alongX, alongY)).translation.max, 0, 1e-9);
}

TEST(AbsoluteTrajectoryError, NeedsThreePairs)
{
	EXPECT_THROW(absoluteTrajectoryError({}), InputError);
	EXPECT_THROW(absoluteTrajectoryError(pairsOf(helix(2), helix(2))), InputError);
	EXPECT_NO_THROW(absoluteTrajectoryError(pairsOf(helix(3), helix(3))));
}

TEST(RelativePoseError, OfAMovedCopyIsZero)
{
	std::vector<CPose3D> estimate;
	for (const auto& pose : helix(20)) estimate.push_back(CPose3D(4, 5, 6, 1, 0.2, -0.5) + pose);
	for (const auto unit : {IntervalUnit::Seconds, IntervalUnit::Metres})
	{
		const auto error = relativePoseError(pairsOf(estimate, helix(20)), 1.0, unit);
		EXPECT_GT(error.translation.count, 10u);
		EXPECT_LT(error.translation.max, 1e-12);
		EXPECT_LT(error.rotation.max, 1e-12);
	}
}

TEST(RelativePoseError, OfAScaledStraightWalkIsTheScaleErrorPerSecond)
{
	// 1.00 m/s in truth, 1.05 m/s estimated, sampled four times a second for 4 s.
	std::vector<CPose3D> truth;
	std::vector<CPose3D> estimate;
	for (int i = 0; i <= 16; i++)
	{
		truth.push_back(position(0.25 * i, 0, 0));
		estimate.push_back(position(1.05 * 0.25 * i, 0, 0));
	}
	const auto error = relativePoseError(pairsOf(estimate, truth, 0.25), 1.0);
	EXPECT_EQ(error.translation.count, 12u);  // not the last second, not to the last pose
	EXPECT_NEAR(error.translation.rmse, 0.05, 1e-9);
	EXPECT_NEAR(error.translation.max, 0.05, 1e-9);
	EXPECT_NEAR(error.rotation.max, 0, 1e-9);
}

TEST(RelativePoseError, OverAMetreCountsTheWayAlongTheEstimate)
{
	// The estimate walks 0.5 m a step, the truth 0.4 m: over 1 m = two steps it is 0.2 m too far.
	std::vector<CPose3D> truth;
	std::vector<CPose3D> estimate;
	for (int i = 0; i < 7; i++)
	{
		truth.push_back(position(0, 0.4 * i, 0));
		estimate.push_back(position(0, 0.5 * i, 0));
	}
	const auto error = relativePoseError(pairsOf(estimate, truth), 1.0, IntervalUnit::Metres);
	EXPECT_EQ(error.translation.count, 4u);
	EXPECT_NEAR(error.translation.mean, 0.2, 1e-9);
}

TEST(RelativePoseError, OfAYawDriftIsItsRate)
{
	// Half a degree a second, on the spot.
	std::vector<CPose3D> truth(6);
	std::vector<CPose3D> estimate;
	for (int i = 0; i < 6; i++) estimate.emplace_back(0, 0, 0, i * 0.5 * kPi / 180, 0, 0);
	const auto error = relativePoseError(pairsOf(estimate, truth), 2.0);
	EXPECT_EQ(error.rotation.count, 3u);
	EXPECT_NEAR(error.rotation.rmse * 180 / kPi, 1.0, 1e-9);
	EXPECT_NEAR(error.translation.max, 0, 1e-12);
}

TEST(RelativePoseError, OfAnAlternatingOffsetShowsOnlyAtOddIntervals)
{
	std::vector<CPose3D> truth(9);
	std::vector<CPose3D> estimate;
	for (int i = 0; i < 9; i++) estimate.push_back(position(i % 2 ? 0.1 : 0, 0, 0));
	const auto pairs = pairsOf(estimate, truth);
	EXPECT_NEAR(relativePoseError(pairs, 1.0).translation.rmse, 0.1, 1e-12);
	EXPECT_NEAR(relativePoseError(pairs, 2.0).translation.rmse, 0.0, 1e-12);
}

TEST(RelativePoseError, OfATrajectoryShorterThanTheIntervalHasNoTerms)
{
	const auto error = relativePoseError(pairsOf(helix(5), helix(5)), 100.0);
	EXPECT_EQ(error.translation.count, 0u);
	EXPECT_EQ(error.translation.rmse, 0);
}

TEST(RelativePoseError, RefusesTooFewPairsAndAnIntervalThatIsNotPositive)
{
	EXPECT_THROW(relativePoseError(pairsOf(helix(2), helix(2))), InputError);
	const auto pairs = pairsOf(helix(5), helix(5));
	EXPECT_THROW(relativePoseError(pairs, 0), UsageError);
	EXPECT_THROW(relativePoseError(pairs, -1), UsageError);
	EXPECT_THROW(relativePoseError(pairs, std::numeric_limits<double>::quiet_NaN()), UsageError);
}

/** Forty poses of RGB-D SLAM on freiburg1_xyz and the benchmark's ground truth. */
std::vector<PosePair> publishedPair()
{
	const std::string folder = SEMLOOP_SOURCE_DIR "/tests/evaluation/published_pair";
	return associateByTime(
		readTumTrajectory(folder + "/estimate.tum"), readTumTrajectory(folder + "/truth.tum"));
}

constexpr double kPrinted = 1e-9;  // the scripts' figures, printed with nine digits

void expectSummary(
	const ErrorSummary& error, std::size_t count, double rmse, double mean, double median,
	double max, double unit = 1)
{
	EXPECT_EQ(error.count, count);
	EXPECT_NEAR(error.rmse / unit, rmse, kPrinted);
	EXPECT_NEAR(error.mean / unit, mean, kPrinted);
	EXPECT_NEAR(error.median / unit, median, kPrinted);
	EXPECT_NEAR(error.max / unit, max, kPrinted);
}

/** What evaluate_ate.py of the TUM RGB-D benchmark prints for the two files. */
TEST(PublishedPair, HasTheAbsoluteErrorOfTheBenchmarksScript)
{
	expectSummary(
		absoluteTrajectoryError(publishedPair()).translation, 40, 0.008189946, 0.007377837,
		0.006996018, 0.014787410);
}

/** What evaluate_rpe.py --fixed_delta --delta 1 (0.1) --delta_unit s (m) prints for them. */
TEST(PublishedPair, HasTheRelativeErrorsOfTheBenchmarksScript)
{
	constexpr double kDegree = kPi / 180;
	const auto pairs = publishedPair();
	const auto second = relativePoseError(pairs, 1.0);
	expectSummary(second.translation, 11, 0.016134575, 0.015244391, 0.016359164, 0.026876793);
	expectSummary(second.rotation, 11, 0.788560172, 0.719726633, 0.612007100, 1.234470691, kDegree);
	const auto metre = relativePoseError(pairs, 0.1, IntervalUnit::Metres);
	expectSummary(metre.translation, 27, 0.009960959, 0.009008969, 0.008232986, 0.018945860);
	expectSummary(metre.rotation, 27, 0.550822647, 0.463609428, 0.405031942, 1.208664684, kDegree);
}
}  // namespace
}  // namespace semloop
