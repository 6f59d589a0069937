#include <gtest/gtest.h>
#include <semloop/simulation/OdometryNoise.h>

#include <Eigen/Geometry>
#include <cmath>

using namespace semloop;
using mrpt::poses::CPose3D;

namespace
{
constexpr double kPi = 3.14159265358979323846;

/** A camera that looks level along the heading [rad]: z of the optical frame forward, y down. */
CPose3D levelCamera(double x, double y, double heading)
{
	return CPose3D(x, y, 1.5, heading, 0, 0) + CPose3D(0, 0, 0, -kPi / 2, 0, -kPi / 2);
}

/** Straight along x, in steps. */
Trajectory straightPath(double length, int steps)
{
	Trajectory path;
	for (int i = 0; i <= steps; i++)
		path.push_back(
			{mrpt::Clock::fromDouble(1000 + 0.1 * i), levelCamera(length * i / steps, 0, 0)});
	return path;
}

OdometryNoiseOptions noNoise()
{
	OdometryNoiseOptions options;
	options.translation = options.rotation = options.yawBias = 0;
	options.scaleBias = options.tilt = 0;
	return options;
}

/** Error of the heading of the optical axis [rad]. */
double headingOf(const CPose3D& camera)
{
	const auto R = camera.getRotationMatrix();
	return std::atan2(R(1, 2), R(0, 2));
}

/** Root of the mean square of a number over 200 seeds. */
template <typename Number>
double spread(const Trajectory& truth, const OdometryNoiseOptions& options, const Number& number)
{
	double squares = 0;
	for (uint64_t seed = 0; seed < 200; seed++)
		squares += std::pow(number(corruptTrajectory(truth, options, seed).back().pose), 2);
	return std::sqrt(squares / 200);
}

}  // namespace

TEST(OdometryNoise, WithoutNoiseTheTruthComesOut)
{
	Trajectory truth;
	for (int i = 0; i < 200; i++)
		truth.push_back(
			{mrpt::Clock::fromDouble(1000 + i),
			 CPose3D(
				 std::sin(0.1 * i), 0.02 * i, 1 + 0.3 * std::cos(0.2 * i), 0.05 * i, 0.3, -0.2)});
	const Trajectory result = corruptTrajectory(truth, noNoise(), 1);
	ASSERT_EQ(result.size(), truth.size());
	for (std::size_t i = 0; i < truth.size(); i++)
	{
		EXPECT_EQ(result[i].time, truth[i].time);
		const CPose3D error = result[i].pose - truth[i].pose;
		EXPECT_LT(error.norm(), 1e-9);
		EXPECT_LT((error.getRotationMatrix().asEigen() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
	}
}

TEST(OdometryNoise, TheFirstPoseIsTrueAndAnEmptyTrajectoryStaysEmpty)
{
	const Trajectory truth = straightPath(10, 100);
	const CPose3D first = corruptTrajectory(truth, {}, 3).front().pose;
	EXPECT_EQ(first.norm(), truth.front().pose.norm());
	EXPECT_TRUE(corruptTrajectory({}, {}, 3).empty());
}

TEST(OdometryNoise, TheYawBiasTurnsTheHeadingInProportionToThePath)
{
	OdometryNoiseOptions options = noNoise();
	options.yawBias = 0.01;
	bool left = false, right = false;
	for (uint64_t seed = 0; seed < 20; seed++)
	{
		const CPose3D end = corruptTrajectory(straightPath(20, 100), options, seed).back().pose;
		EXPECT_NEAR(std::abs(headingOf(end)), 0.2, 1e-9);
		EXPECT_NEAR(end.z(), 1.5, 1e-9);
		// A circle of radius 1 / 0.01: the chord of 20 m at half of the angle, to the step's size.
		EXPECT_NEAR(std::abs(end.y()), 100 * (1 - std::cos(0.2)), 0.03);
		(headingOf(end) > 0 ? left : right) = true;
	}
	EXPECT_TRUE(left && right);
}

TEST(OdometryNoise, TheScaleBiasLengthensOrShortensThePath)
{
	OdometryNoiseOptions options = noNoise();
	options.scaleBias = 0.02;
	bool longer = false, shorter = false;
	for (uint64_t seed = 0; seed < 20; seed++)
	{
		const double x = corruptTrajectory(straightPath(10, 50), options, seed).back().pose.x();
		EXPECT_NEAR(std::abs(x - 10), 0.2, 1e-9);
		(x > 10 ? longer : shorter) = true;
	}
	EXPECT_TRUE(longer && shorter);
}

// 200 seeds know a standard deviation within 5 %: 15 % are three times that.

TEST(OdometryNoise, TheHeadingsRandomWalkGrowsWithTheRootOfThePath)
{
	OdometryNoiseOptions options = noNoise();
	options.rotation = 0.005;
	for (const int steps : {20, 200})
	{
		const double sigma = spread(straightPath(16, steps), options, headingOf);
		EXPECT_NEAR(sigma, 0.005 * 4, 0.15 * 0.02) << steps;
	}
}

TEST(OdometryNoise, ThePositionsRandomWalkGrowsWithTheRootOfThePath)
{
	OdometryNoiseOptions options = noNoise();
	options.translation = 0.02;
	for (const int steps : {9, 300})
	{
		const Trajectory truth = straightPath(9, steps);
		const double x = spread(truth, options, [](const CPose3D& p) { return p.x() - 9; });
		const double z = spread(truth, options, [](const CPose3D& p) { return p.z() - 1.5; });
		EXPECT_NEAR(x, 0.06, 0.15 * 0.06) << steps;
		EXPECT_NEAR(z, 0.06, 0.15 * 0.06) << steps;
	}
}

TEST(OdometryNoise, TheTiltTurnsAboutLevelAxes)
{
	OdometryNoiseOptions options = noNoise();
	options.tilt = 0.001;
	const auto pitch = [](const CPose3D& camera)
	{ return std::asin(camera.getRotationMatrix()(2, 2)); };
	EXPECT_NEAR(spread(straightPath(16, 100), options, pitch), 0.004, 0.15 * 0.004);
	EXPECT_LT(spread(straightPath(16, 100), options, headingOf), 1e-4);
}

TEST(OdometryNoise, ACameraThatStandsStillDoesNotDrift)
{
	const Trajectory truth = straightPath(0, 100);
	EXPECT_LT((corruptTrajectory(truth, {}, 1).back().pose - truth.back().pose).norm(), 1e-12);
}

TEST(OdometryNoise, TheSeedDecidesTheResult)
{
	const Trajectory truth = straightPath(10, 20);
	const auto x = [&](uint64_t seed)
	{ return corruptTrajectory(truth, {}, seed).back().pose.x(); };
	EXPECT_EQ(x(1), x(1));
	EXPECT_NE(x(1), x(2));
}
