#include <gtest/gtest.h>
#include <semloop/slam/DriftPrior.h>

#include <cmath>

using mrpt::poses::CPose3D;

namespace semloop
{
namespace
{
constexpr double kQuarter = M_PI / 2;

/** Odometry along the robot's x axis, a metre a frame. */
DriftPrior straightAhead(int frames, double varianceTranslation, double varianceRotation)
{
	DriftPrior prior;
	OdometryEstimate step;
	step.covariance.setZero();
	prior.add(step);
	step.T_previous_camera = CPose3D(1, 0, 0, 0, 0, 0);
	step.covariance.topLeftCorner<3, 3>() = varianceTranslation * Eigen::Matrix3d::Identity();
	step.covariance.bottomRightCorner<3, 3>() = varianceRotation * Eigen::Matrix3d::Identity();
	for (int i = 1; i < frames; ++i) prior.add(step);
	return prior;
}
}  // namespace

TEST(DriftPrior, IsCertainOfAFrameAgainstItself)
{
	EXPECT_TRUE(straightAhead(5, 0.01, 0.01).covariance(3, 3).isZero());
}

TEST(DriftPrior, AddsUpTheVarianceOfSteps)
{
	const Matrix6 P = straightAhead(5, 0.01, 0).covariance(0, 4);
	EXPECT_NEAR(P(0, 0), 0.04, 1e-12);
	EXPECT_NEAR(P(1, 1), 0.04, 1e-12);
	EXPECT_NEAR(P(5, 5), 0, 1e-12);
}

TEST(DriftPrior, TurnsAnEarlyErrorOfHeadingIntoOneOfThePlace)
{
	// Yaw errors of the steps act over the 3, 2, 1 and 0 metres that follow: 0.01 (9 + 4 + 1 + 0).
	const Matrix6 P = straightAhead(5, 0, 0.01).covariance(0, 4);
	EXPECT_NEAR(P(1, 1), 0.14, 1e-12);
	EXPECT_NEAR(P(0, 0), 0, 1e-12);
	EXPECT_NEAR(P(5, 5), 0.04, 1e-12);
}

TEST(DriftPrior, CountsFromAnyFrameOnAlsoOnACurvedWay)
{
	const Matrix6 straight = straightAhead(5, 0.01, 0.01).covariance(2, 4);
	// Two steps; a yaw error of the first acts over the metre of the second.
	EXPECT_NEAR(straight(0, 0), 0.02, 1e-12);
	EXPECT_NEAR(straight(1, 1), 0.02 + 0.01, 1e-12);
	EXPECT_NEAR(straight(5, 5), 0.02, 1e-12);

	// What happened before does not matter: the same two steps after a curve and alone.
	OdometryEstimate step;
	step.covariance.setZero();
	DriftPrior curved, alone;
	curved.add(step);
	alone.add(step);
	for (int i = 0; i < 40; ++i)
	{
		step.T_previous_camera = CPose3D(1, 0.2 * (i % 3), 0.1, 0.3, 0.05, -0.1);
		step.covariance = (0.01 + 0.001 * i) * Matrix6::Identity();
		curved.add(step);
		if (i >= 38) alone.add(step);
	}
	EXPECT_TRUE(curved.covariance(38, 40).isApprox(alone.covariance(0, 2), 1e-9));
}

TEST(DriftPrior, FindsNoCorrectionJustWhatItExpects)
{
	const DriftPrior prior = straightAhead(5, 0.01, 0.001);
	EXPECT_EQ(prior.sigmas(0, 4, CPose3D(4, 0, 0, 0, 0, 0), CPose3D(), {5, 1, 0}), 0);
}

TEST(DriftPrior, MeasuresACorrectionInStandardDeviations)
{
	// Without drift only the loop closure itself errs, by 0.3 m and 0.15 rad.
	const DriftPrior exact = straightAhead(5, 0, 0);
	const CPose3D here(4, 0, 0, 0, 0, 0);
	EXPECT_NEAR(exact.sigmas(0, 4, here, CPose3D(0.6, 0, 0, 0, 0, 0), {5, 1, 0}), 2, 1e-9);
	EXPECT_NEAR(exact.sigmas(0, 4, here, CPose3D(0, 0, 0, 0.3, 0, 0), {0, 0, 0}), 2, 1e-9);

	// Four steps of 0.2 m make 0.4 m, with the 0.3 m of the loop closure 0.5 m.
	const DriftPrior drifting = straightAhead(5, 0.04, 0);
	EXPECT_NEAR(drifting.sigmas(0, 4, here, CPose3D(0, 1, 0, 0, 0, 0), {5, 1, 0}), 2, 1e-9);
}

TEST(DriftPrior, JudgesByTheMotionOfThePointAndNotOfTheWorldsOrigin)
{
	// A turn about the point itself leaves it where it is, however far from the origin.
	const DriftPrior exact = straightAhead(2, 0, 0);
	const CPose3D about =
		CPose3D(10, 0, 0, 0, 0, 0) + CPose3D(0, 0, 0, 0.15, 0, 0) + CPose3D(-10, 0, 0, 0, 0, 0);
	EXPECT_NEAR(exact.sigmas(0, 1, CPose3D(1, 0, 0, 0, 0, 0), about, {10, 0, 0}), 1, 1e-6);
}

TEST(DriftPrior, TellsALoopDetectorItsStandardDeviations)
{
	const CPose3D here(4, 0, 0, 0, 0, 0);
	// Four steps of 0.2 m make 0.4 m, with the 0.3 m of the loop closure 0.5 m.
	const PosePrior drifting = straightAhead(5, 0.04, 0).prior(0, 4, here, {5, 1, 0});
	EXPECT_EQ(drifting.T_target_query, CPose3D());
	EXPECT_NEAR(drifting.sigmaXY, 0.5, 1e-9);
	EXPECT_NEAR(drifting.sigmaZ, 0.5, 1e-9);
	EXPECT_NEAR(drifting.sigmaYaw, 0.15, 1e-9);
	// Sideways 0.14 m^2 as above, along the path nothing: the larger counts.
	const PosePrior turning = straightAhead(5, 0, 0.01).prior(0, 4, here, {4, 0, 0});
	EXPECT_NEAR(turning.sigmaXY, std::sqrt(0.14 + 0.09), 1e-9);
	EXPECT_NEAR(turning.sigmaZ, std::sqrt(0.14 + 0.09), 1e-9);
	EXPECT_NEAR(turning.sigmaYaw, 0.25, 1e-9);
}

TEST(DriftPrior, DoesNotDependOnWhereTheCameraLooks)
{
	const DriftPrior prior = straightAhead(4, 0.02, 0.0);
	const CPose3D correction(0.4, 0.3, 0, 0, 0, 0);
	EXPECT_NEAR(
		prior.sigmas(0, 3, CPose3D(3, 0, 0, 0, 0, 0), correction, {3, 0, 0}),
		prior.sigmas(0, 3, CPose3D(3, 0, 0, kQuarter, 0, 0), correction, {3, 0, 0}), 1e-9);
}

}  // namespace semloop
