#include <gtest/gtest.h>

#include <cmath>

#include "RecordedOdometryFixture.h"

namespace semloop::test
{
namespace
{
/** What is added to a recorded trajectory for experiments: drift and noise. */
class RecordedOdometryNoise : public RecordedOdometryFile
{
};

TEST_F(RecordedOdometryNoise, DriftGrowsEvenlyToItsValueAtTheFilesEnd)
{
	auto options = optionsWithFile(0, 4);
	RecordedOdometry exact(options);
	options.drift = 0.5;
	RecordedOdometry drifting(options);
	for (int i = 0; i <= 30; i++)
	{
		const double t = 1 + 0.1 * i;  // the frames begin a second after the file
		const auto truth = exact.track(frameOf(t)).T_odom_camera;
		const auto estimate = drifting.track(frameOf(t)).T_odom_camera;
		EXPECT_NEAR(estimate.x() - truth.x(), 0.5 * i / 30, 1e-6);
		EXPECT_NEAR(estimate.y(), truth.y(), 1e-9);
		EXPECT_LT(angleOf(estimate - truth), 1e-6);
	}
}

TEST_F(RecordedOdometryNoise, DriftingRelativePosesAreThoseOfTheDriftedTrajectory)
{
	auto options = optionsWithFile(0, 4);
	options.drift = 0.5;
	options.driftYaw = mrpt::DEG2RAD(5.0);
	RecordedOdometry odometry(options);
	CPose3D product;
	OdometryEstimate estimate;
	for (int i = 0; i <= 40; i++)
	{
		estimate = odometry.track(frameOf(0.1 * i));
		expectSound(estimate);
		product = product + estimate.T_previous_camera;
	}
	expectPoseNear(product, estimate.T_odom_camera, 1e-9, 1e-9);
	const CPose3D truth = recorded(4) - recorded(0);
	EXPECT_NEAR((estimate.T_odom_camera.translation() - truth.translation()).norm(), 0.5, 1e-6);
	EXPECT_NEAR(angleOf(estimate.T_odom_camera - truth), mrpt::DEG2RAD(5.0), 1e-6);
}

TEST_F(RecordedOdometryNoise, CovarianceOwnsUpToTheDrift)
{
	// Over the whole file the variances add up to drift^2, besides those of the steps.
	auto options = optionsWithFile(0, 4);
	RecordedOdometry exact(options);
	options.drift = 0.5;
	RecordedOdometry drifting(options);
	double sum = 0;
	for (int i = 0; i <= 40; i++)
		sum += drifting.track(frameOf(0.1 * i)).covariance(0, 0) -
			   exact.track(frameOf(0.1 * i)).covariance(0, 0);
	EXPECT_NEAR(sum, 0.25, 0.001);
}

TEST_F(RecordedOdometryNoise, NoiseHasItsStandardDeviationInEveryAxisAndDoesNotAddUp)
{
	auto options = optionsWithFile(0, 100);
	RecordedOdometry exact(options);
	options.noise = 0.1;
	options.noiseAngle = mrpt::DEG2RAD(2.0);
	RecordedOdometry noisy(options);
	expectPoseNear(noisy.track(frameOf(0)).T_odom_camera, CPose3D(), 1e-9, 1e-9);
	exact.track(frameOf(0));
	Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
	double angles = 0;
	const int count = 1000;
	for (int i = 1; i <= count; i++)
	{
		const auto truth = exact.track(frameOf(0.1 * i)).T_odom_camera;
		const auto estimate = noisy.track(frameOf(0.1 * i));
		expectSound(estimate);
		const auto n = estimate.T_odom_camera.translation() - truth.translation();
		sum += Eigen::Vector3d(n.x, n.y, n.z);
		squares += Eigen::Vector3d(n.x * n.x, n.y * n.y, n.z * n.z);
		angles += std::pow(angleOf(estimate.T_odom_camera - truth), 2);
	}
	// Of n samples the mean has sigma / sqrt(n), the variance a relative error of sqrt(2 / n): 4 sigma.
	for (int axis = 0; axis < 3; axis++)
	{
		EXPECT_NEAR(sum[axis] / count, 0, 4 * 0.1 / std::sqrt(count));
		EXPECT_NEAR(squares[axis] / count, 0.01, 4 * 0.01 * std::sqrt(2.0 / count));
	}
	const double variance = std::pow(mrpt::DEG2RAD(2.0), 2);
	EXPECT_NEAR(angles / count, 3 * variance, 4 * variance * std::sqrt(6.0 / count));
}

TEST_F(RecordedOdometryNoise, NoiseIsThatOfItsSeed)
{
	auto options = optionsWithFile(0, 1);
	options.noise = 0.1;
	const auto positionWith = [&](int seed)
	{
		options.noiseSeed = seed;
		RecordedOdometry odometry(options);
		odometry.track(frameOf(0));
		return odometry.track(frameOf(0.1)).T_odom_camera.translation();
	};
	EXPECT_EQ(positionWith(7), positionWith(7));
	EXPECT_NE(positionWith(7), positionWith(8));
}

TEST_F(RecordedOdometryNoise, CovarianceOwnsUpToTheNoiseOfBothPosesOfAStep)
{
	RecordedOdometryOptions options;
	options.file = folder_.file("still.tum");
	writeTumTrajectory(options.file, {{at(0), {}}, {at(0.1), {}}});
	options.sigmaTranslationPerMetre = options.sigmaRotationPerRadian = 0;
	options.sigmaTranslationFloor = options.sigmaRotationFloor = 0.01;
	options.noise = 0.1;
	options.noiseAngle = 0.2;
	RecordedOdometry odometry(options);
	odometry.track(frameOf(0));
	const auto step = odometry.track(frameOf(0.1));
	EXPECT_NEAR(step.covariance(1, 1), 2 * 0.1 * 0.1 + 1e-4, 1e-12);
	EXPECT_NEAR(step.covariance(4, 4), 2 * 0.2 * 0.2 + 1e-4, 1e-12);
}
}  // namespace
}  // namespace semloop::test
