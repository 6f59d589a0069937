#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/observations/CameraFrames.h>

#include <string>

#include "RecordedOdometryFixture.h"

namespace semloop::test
{
namespace
{
using Status = OdometryEstimate::Status;
using ::testing::HasSubstr;

TEST_F(RecordedOdometryFile, GivesTheFilesMotionFromTheFirstFrameOn)
{
	RecordedOdometry odometry(optionsWithFile(0, 4));
	const auto first = odometry.track(frameOf(1.0));
	expectSound(first);
	expectPoseNear(first.T_odom_camera, CPose3D(), 1e-9, 1e-9);

	CPose3D product = first.T_previous_camera;
	for (const double t : {1.1, 1.5, 2.0, 4.0})
	{
		const auto estimate = odometry.track(frameOf(t));
		expectSound(estimate);
		EXPECT_EQ(estimate.status, Status::Tracked);
		expectPoseNear(estimate.T_odom_camera, recorded(t) - recorded(1.0), 1e-6, 1e-6);
		product = product + estimate.T_previous_camera;
		expectPoseNear(product, estimate.T_odom_camera, 1e-9, 1e-9);
	}
}

TEST_F(RecordedOdometryFile, InterpolatesBetweenItsPoses)
{
	RecordedOdometry odometry(optionsWithFile(0, 4));
	odometry.track(frameOf(1.0));
	const auto estimate = odometry.track(frameOf(1.25));
	// The curve bends by 0.1 * 0.05^2 m between two poses.
	expectPoseNear(estimate.T_odom_camera, recorded(1.25) - recorded(1.0), 3e-4, 1e-4);
}

TEST_F(RecordedOdometryFile, BeyondTheFileIsLostAndGoesOnAsBefore)
{
	RecordedOdometry odometry(optionsWithFile(0, 2));
	odometry.track(frameOf(1.8));
	odometry.track(frameOf(1.9));
	const auto last = odometry.track(frameOf(2.0));
	const auto lost = odometry.track(frameOf(2.1));
	expectSound(lost);
	EXPECT_EQ(lost.status, Status::Lost);
	EXPECT_THAT(lost.reason, HasSubstr("odometry.tum"));
	expectPoseNear(lost.T_previous_camera, last.T_previous_camera, 1e-6, 1e-6);
	EXPECT_GT(lost.covariance.trace(), last.covariance.trace());
	EXPECT_GT(odometry.track(frameOf(2.2)).covariance.trace(), lost.covariance.trace());
}

TEST_F(RecordedOdometryFile, BeforeTheFileIsLostAtTheOrigin)
{
	RecordedOdometry odometry(optionsWithFile(1, 2));
	const auto before = odometry.track(frameOf(0.5));
	expectSound(before);
	EXPECT_EQ(before.status, Status::Lost);
	EXPECT_EQ(before.T_odom_camera.norm(), 0);
	expectPoseNear(odometry.track(frameOf(1.0)).T_odom_camera, CPose3D(), 1e-9, 1e-9);
	expectPoseNear(
		odometry.track(frameOf(1.5)).T_odom_camera, recorded(1.5) - recorded(1.0), 1e-6, 1e-6);
}

TEST_F(RecordedOdometryFile, AGapInTheFileIsLostAndMendedBehindIt)
{
	auto options = optionsWithFile(0, 1);
	auto trajectory = readTumTrajectory(options.file);
	for (const double t : {3.0, 3.1, 3.2}) trajectory.push_back({at(t), recorded(t)});
	writeTumTrajectory(options.file, trajectory);

	RecordedOdometry odometry(options);
	odometry.track(frameOf(0.9));
	const auto tracked = odometry.track(frameOf(1.0));
	EXPECT_EQ(odometry.track(frameOf(2.0)).status, Status::Lost);
	const auto behind = odometry.track(frameOf(3.0));
	EXPECT_EQ(behind.status, Status::Tracked);
	expectPoseNear(behind.T_odom_camera, recorded(3.0) - recorded(0.9), 1e-6, 1e-6);
	// The step undoes a guess: it is as uncertain as the guess was, the next one is not.
	EXPECT_GT(behind.covariance.trace(), 10 * tracked.covariance.trace());
	EXPECT_LT(odometry.track(frameOf(3.1)).covariance.trace(), 2 * tracked.covariance.trace());
}

TEST_F(RecordedOdometryFile, CovarianceGrowsWithTheStep)
{
	auto options = optionsWithFile(0, 4);
	options.sigmaTranslationPerMetre = 0.1;
	options.sigmaTranslationFloor = 0.01;
	RecordedOdometry odometry(options);
	odometry.track(frameOf(0));
	const auto estimate = odometry.track(frameOf(2));
	const double length = estimate.T_previous_camera.norm();
	EXPECT_NEAR(estimate.covariance(0, 0), 0.01 * length * length + 1e-4, 1e-9);
}

TEST_F(RecordedOdometryFile, RefusesAMissingAnEmptyAndAMalformedFile)
{
	RecordedOdometryOptions options;
	options.file = folder_.file("missing.tum");
	EXPECT_THAT(
		messageOf<InputError>([&] { RecordedOdometry odometry(options); }),
		HasSubstr("missing.tum"));
	options.file = folder_.write("empty.tum", "# t tx ty tz qx qy qz qw\n");
	EXPECT_THAT(
		messageOf<InputError>([&] { RecordedOdometry odometry(options); }), HasSubstr("empty.tum"));
	options.file = folder_.write("bad.tum", "1 2 3\n");
	EXPECT_THAT(
		messageOf<InputError>([&] { RecordedOdometry odometry(options); }), HasSubstr("bad.tum:1"));
}

TEST_F(RecordedOdometryFile, IsMadeByNameAndConfiguredFromItsSection)
{
	const auto odometry = makeModule<Odometry>("semloop::RecordedOdometry", "[modules] odometry");
	mrpt::config::CConfigFileMemory config;
	config.write("odometry", "file", optionsWithFile(0, 1).file);
	config.write("odometry", "drift", 0.5);
	odometry->configure(config, "odometry");
	odometry->track(frameOf(0));
	const CPose3D truth = recorded(1) - recorded(0);
	EXPECT_NEAR(odometry->track(frameOf(1)).T_odom_camera.x() - truth.x(), 0.5, 1e-6);
}

TEST(RecordedOdometry, RefusesADriftWithoutAFileAndUnknownKeys)
{
	mrpt::config::CConfigFileMemory drift;
	drift.write("odometry", "drift", 0.5);
	RecordedOdometry odometry;
	EXPECT_THROW(odometry.configure(drift, "odometry"), UsageError);
	mrpt::config::CConfigFileMemory unknown;
	unknown.write("odometry", "fil", std::string("x.tum"));
	EXPECT_THROW(odometry.configure(unknown, "odometry"), UsageError);
}

/** A robot whose camera looks ahead, 0.3 m before its centre. */
RgbdFrame robotFrame(double seconds)
{
	auto frame = frameOf(seconds);
	frame.T_robot_camera = robotFromCamera(CPose3D(0.3, 0, 0.5, 0, 0, 0));
	return frame;
}

mrpt::obs::CObservationOdometry reading(double seconds, double x, double y, double phi)
{
	mrpt::obs::CObservationOdometry observation;
	observation.timestamp = at(seconds);
	observation.odometry = mrpt::poses::CPose2D(x, y, phi);
	return observation;
}

TEST(RecordedOdometry, CarriesTheRobotsWayToTheCamera)
{
	RecordedOdometry odometry;
	odometry.observe(reading(0, 7, 8, 0));
	expectPoseNear(odometry.track(robotFrame(0)).T_odom_camera, CPose3D(), 1e-9, 1e-9);
	odometry.observe(reading(0.1, 7.2, 8, 0));
	const auto ahead = odometry.track(robotFrame(0.1));
	expectSound(ahead);
	EXPECT_EQ(ahead.status, Status::Tracked);
	// 0.2 m ahead of the robot is 0.2 m along the camera's axis.
	expectPoseNear(ahead.T_odom_camera, CPose3D(0, 0, 0.2, 0, 0, 0), 1e-9, 1e-9);
}

TEST(RecordedOdometry, TurnsTheCameraAboutTheRobotsCentre)
{
	RecordedOdometry odometry;
	odometry.observe(reading(0, 0, 0, 0));
	odometry.track(robotFrame(0));
	odometry.observe(reading(0.1, 0, 0, M_PI / 2));
	const auto estimate = odometry.track(robotFrame(0.1));
	// From 0.3 m ahead to 0.3 m to the left: in the first camera's frame x = -0.3, z = -0.3.
	EXPECT_NEAR(estimate.T_odom_camera.x(), -0.3, 1e-9);
	EXPECT_NEAR(estimate.T_odom_camera.y(), 0, 1e-9);
	EXPECT_NEAR(estimate.T_odom_camera.z(), -0.3, 1e-9);
	EXPECT_NEAR(angleOf(estimate.T_odom_camera), M_PI / 2, 1e-9);
}

TEST(RecordedOdometry, GoesOnAtTheLastSpeedForTheGapAndIsLostAfterIt)
{
	RecordedOdometryOptions options;
	options.maxGap = 0.2;
	RecordedOdometry odometry(options);
	odometry.observe(reading(0, 0, 0, 0));
	odometry.track(robotFrame(0));
	odometry.observe(reading(0.1, 0.1, 0, 0));
	EXPECT_NEAR(odometry.track(robotFrame(0.15)).T_odom_camera.z(), 0.15, 1e-6);
	const auto late = odometry.track(robotFrame(0.5));
	expectSound(late);
	EXPECT_EQ(late.status, Status::Lost);
	EXPECT_THAT(late.reason, HasSubstr("CObservationOdometry"));
}

TEST(RecordedOdometry, InterpolatesReadingsThatArriveOutOfOrder)
{
	RecordedOdometry odometry;
	odometry.observe(reading(0, 0, 0, 0));
	odometry.track(robotFrame(0));
	odometry.observe(reading(0.2, 0.4, 0, 0));
	odometry.observe(reading(0.1, 0.1, 0, 0));
	EXPECT_NEAR(odometry.track(robotFrame(0.15)).T_odom_camera.z(), 0.25, 1e-6);
}

TEST(RecordedOdometry, WithoutAnyReadingIsLostAndSound)
{
	RecordedOdometry odometry;
	odometry.observe(mrpt::obs::CObservationIMU());
	for (const double t : {0.0, 0.1, 0.2})
	{
		const auto estimate = odometry.track(robotFrame(t));
		expectSound(estimate);
		EXPECT_EQ(estimate.status, Status::Lost);
		EXPECT_EQ(estimate.T_odom_camera.norm(), 0);
	}
}
}  // namespace
}  // namespace semloop::test
