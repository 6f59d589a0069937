#include <gtest/gtest.h>
#include <semloop/slam/CameraCorrection.h>

#include <cmath>

using namespace semloop;
using mrpt::poses::CPose3D;

namespace
{
OdometryEstimate step(const CPose3D& T_previous_camera, double sigma)
{
	OdometryEstimate estimate;
	estimate.T_previous_camera = T_previous_camera;
	estimate.covariance = sigma * sigma * Eigen::Matrix<double, 6, 6>::Identity();
	return estimate;
}

FrameRegistration seen(const CPose3D& T_seen_expected, double sigma)
{
	return {T_seen_expected, {sigma, sigma}, 5};
}

const CPose3D kHere;
}  // namespace

TEST(CameraCorrection, IsNoneWithoutObjects)
{
	CameraCorrection correction;
	for (int i = 0; i < 10; ++i)
	{
		correction.step(step(CPose3D(0.1, 0, 0, 0.2, 0, 0), 0.01));
		correction.track({kHere, correction.stepSigma(), 0});
		correction.localize({kHere, correction.sigma(), 0});
	}
	EXPECT_NEAR(correction.T_odometry_camera().norm(), 0, 1e-12);
}

TEST(CameraCorrection, CollectsTheStepsBetweenSegmentedFrames)
{
	CameraCorrection correction;
	correction.step(step(CPose3D(1, 0, 0, M_PI / 2, 0, 0), 0.3));
	correction.step(step(CPose3D(1, 0, 0, 0, 0, 0), 0.4));
	EXPECT_NEAR(correction.T_previous_camera().x(), 1, 1e-12);
	EXPECT_NEAR(correction.T_previous_camera().y(), 1, 1e-12);
	EXPECT_NEAR(correction.stepSigma().translation, 0.5, 1e-12);
	correction.track({});
	EXPECT_EQ(correction.T_previous_camera(), kHere);
	EXPECT_EQ(correction.stepSigma().rotation, 0);
}

TEST(CameraCorrection, WeighsWhatObjectsAndOdometrySay)
{
	// One pose of the odometry has a variance of 0.02 / 2, as the tracked objects: half way.
	CameraCorrection correction;
	correction.step(step(kHere, std::sqrt(0.02)));
	correction.track(seen(CPose3D(-0.2, 0, 0, 0.4, 0, 0), 0.1));
	const CPose3D expected = -CPose3D(-0.2, 0, 0, 0.4, 0, 0);
	EXPECT_NEAR(correction.T_odometry_camera().x(), expected.x() / 2, 1e-9);
	EXPECT_NEAR(correction.T_odometry_camera().y(), expected.y() / 2, 1e-9);
	EXPECT_NEAR(correction.T_odometry_camera().yaw(), -0.2, 1e-9);
	EXPECT_NEAR(correction.sigma().translation, 0.1 / std::sqrt(2), 1e-9);
}

TEST(CameraCorrection, FollowsAGoodOdometryWhateverTheObjectsSay)
{
	CameraCorrection correction;
	correction.step(step(kHere, 0.001));
	correction.track(seen(CPose3D(0.2, 0, 0, 0.1, 0, 0), 0.05));
	EXPECT_LT(correction.T_odometry_camera().norm(), 1e-4);
}

TEST(CameraCorrection, FollowsTheObjectsWhenTheOdometryIsLost)
{
	CameraCorrection correction;
	correction.step(step(kHere, 10));
	correction.track(seen(CPose3D(0.2, 0, 0, 0, 0, 0), 0.05));
	EXPECT_NEAR(correction.T_odometry_camera().x(), -0.2, 1e-4);
	EXPECT_NEAR(correction.sigma().translation, 0.05, 1e-4);
}

TEST(CameraCorrection, WhatTheOdometryLostForGoodStaysCorrected)
{
	CameraCorrection correction;
	OdometryEstimate lost = step(kHere, 0.5);
	lost.status = OdometryEstimate::Status::Lost;
	for (int i = 0; i < 3; ++i)
	{
		correction.step(lost);
		correction.track(seen(CPose3D(0.1, 0, 0, 0, 0, 0), 0.02));
		correction.localize({kHere, {0.02, 0.02}, 5});
	}
	ASSERT_NEAR(correction.T_odometry_camera().x(), -0.3, 0.01);
	for (int i = 0; i < 5; ++i)
	{
		correction.step(step(CPose3D(0.1, 0, 0, 0, 0, 0), 0.002));
		correction.track({kHere, {0.002, 0.002}, 5});
		correction.localize({kHere, correction.sigma(), 5});
		EXPECT_NEAR(correction.T_odometry_camera().x(), -0.3, 0.02) << i;
	}
}

TEST(CameraCorrection, ALossThatWasMendedLeavesNoCorrection)
{
	// Recorded odometry jumps back by what it missed: the objects see that step to be wrong for them.
	CameraCorrection correction;
	OdometryEstimate lost = step(kHere, 0.5);
	lost.status = OdometryEstimate::Status::Lost;
	correction.step(lost);
	correction.track(seen(CPose3D(-0.3, 0, 0, 0, 0, 0), 0.02));
	correction.localize({kHere, {0.02, 0.02}, 5});
	ASSERT_NEAR(correction.T_odometry_camera().x(), 0.3, 0.01);
	correction.step(step(CPose3D(0.3, 0, 0, 0, 0, 0), 0.5));
	correction.track(seen(CPose3D(0.3, 0, 0, 0, 0, 0), 0.02));
	correction.localize({kHere, {0.02, 0.02}, 5});
	for (int i = 0; i < 3; ++i)
	{
		correction.step(step(kHere, 0.002));
		correction.track({kHere, {0.002, 0.002}, 5});
		correction.localize({kHere, correction.sigma(), 5});
	}
	EXPECT_NEAR(correction.T_odometry_camera().x(), 0, 0.02);
}

TEST(CameraCorrection, FramesWithoutSegmentationMakeOnePoseNoWorse)
{
	// Of five steps the tracks' uncertainty is sqrt(5) times, that of the last pose is as of any.
	CameraCorrection correction;
	for (int i = 0; i < 5; ++i) correction.step(step(kHere, std::sqrt(0.02)));
	EXPECT_NEAR(correction.stepSigma().translation, std::sqrt(0.1), 1e-9);
	correction.track(seen(CPose3D(-0.2, 0, 0, 0, 0, 0), 0.1));
	EXPECT_NEAR(correction.T_odometry_camera().x(), 0.1, 1e-9);
}

TEST(CameraCorrection, TakesWhatTheMapSaysAsItIs)
{
	CameraCorrection correction;
	correction.localize(seen(CPose3D(0.1, 0.2, 0.3, 0, 0, 0), 0.02));
	EXPECT_NEAR(correction.T_odometry_camera().y(), -0.2, 1e-12);
	EXPECT_EQ(correction.sigma().translation, 0.02);
}

TEST(CameraCorrection, TurnsWithTheCamera)
{
	// A metre to the camera's left in its old frame lies ahead after a quarter turn to the left.
	CameraCorrection correction;
	correction.localize(seen(CPose3D(0, -1, 0, 0, 0, 0), 0.02));
	correction.step(step(CPose3D(0, 0, 0, M_PI / 2, 0, 0), 0.01));
	EXPECT_NEAR(correction.T_odometry_camera().x(), 1, 1e-12);
	EXPECT_NEAR(correction.T_odometry_camera().y(), 0, 1e-12);

	// T_odometry_camera seen from elsewhere: T_world_odometry T_odometry_camera = T_world_camera holds.
	CameraCorrection turned;
	turned.localize(seen(-CPose3D(0.1, 0, 0, M_PI / 2, 0, 0), 0.02));
	const CPose3D ahead(2, 0, 0, 0, 0, 0);
	turned.step(step(ahead, 0.01));
	const CPose3D T_world_camera = CPose3D(0.1, 0, 0, M_PI / 2, 0, 0) + ahead;
	const CPose3D actual = ahead + turned.T_odometry_camera();
	EXPECT_NEAR(actual.x(), T_world_camera.x(), 1e-12);
	EXPECT_NEAR(actual.y(), T_world_camera.y(), 1e-12);
}
