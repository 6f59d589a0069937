#include <gmock/gmock.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/odometry/OpenCvOdometry.h>

#include <limits>
#include <string>

#include "OdometryFixtures.h"

namespace semloop::test
{
namespace
{
using Status = OdometryEstimate::Status;
using ::testing::HasSubstr;

constexpr double kPeriod = 1.0 / 30;

OpenCvOdometryOptions testOptions()
{
	OpenCvOdometryOptions options;
	options.pyramidLevels = 3;  // of 320 x 240
	return options;
}

/** Follows the path for some frames from the first on; the last estimate. */
OdometryEstimate follow(OpenCvOdometry& odometry, int first, int last)
{
	OdometryEstimate estimate;
	for (int i = first; i <= last; i++)
	{
		estimate = odometry.track(frameOnPath(i * kPeriod));
		expectSound(estimate);
	}
	return estimate;
}

CPose3D truth(int frame)
{
	return onPath(frame * kPeriod) - onPath(0);
}

RgbdFrame withoutDepth(int i)
{
	auto frame = frameOnPath(i * kPeriod);
	frame.depth.setTo(0);
	return frame;
}

TEST(OpenCvOdometry, StartsAtTheIdentity)
{
	OpenCvOdometry odometry(testOptions());
	const auto estimate = odometry.track(frameOnPath(0));
	expectSound(estimate);
	EXPECT_EQ(estimate.status, Status::Tracked);
	EXPECT_EQ(estimate.T_odom_camera.norm(), 0);
	EXPECT_EQ(estimate.T_previous_camera.norm(), 0);
}

class OpenCvOdometryMethod : public ::testing::TestWithParam<std::string>
{
};

TEST_P(OpenCvOdometryMethod, FollowsAKnownPath)
{
	auto options = testOptions();
	options.method = GetParam();
	for (const bool keyframes : {true, false})
	{
		options.keyframes = keyframes;
		OpenCvOdometry odometry(options);
		const auto estimate = follow(odometry, 0, 12);
		EXPECT_EQ(estimate.status, Status::Tracked) << estimate.reason;
		expectPoseNear(estimate.T_odom_camera, truth(12), 0.01, 0.005);
	}
}

INSTANTIATE_TEST_SUITE_P(
	All, OpenCvOdometryMethod, ::testing::Values("automatic", "rgbd_icp", "rgbd", "icp"));

TEST(OpenCvOdometry, WorksWithoutTheRefinement)
{
	auto options = testOptions();
	options.refineIterations = 0;
	OpenCvOdometry odometry(options);
	expectPoseNear(follow(odometry, 0, 8).T_odom_camera, truth(8), 0.02, 0.01);
}

TEST(OpenCvOdometry, RelativePosesMultiplyToTheWholeWhileTrackedAndWhileLost)
{
	OpenCvOdometry odometry(testOptions());
	CPose3D product;
	OdometryEstimate estimate;
	for (int i = 0; i < 10; i++)
	{
		const bool blind = i == 4 || i == 5;
		estimate = odometry.track(blind ? withoutDepth(i) : frameOnPath(i * kPeriod));
		expectSound(estimate);
		EXPECT_EQ(estimate.status == Status::Lost, blind) << i << ": " << estimate.reason;
		product = product + estimate.T_previous_camera;
	}
	expectPoseNear(product, estimate.T_odom_camera, 1e-9, 1e-9);
}

TEST(OpenCvOdometry, StandingStillDoesNotDriftWithNoisyDepth)
{
	OpenCvOdometry odometry(testOptions());
	OdometryEstimate estimate;
	for (int i = 0; i < 12; i++)
	{
		auto frame = frameAt(i * kPeriod, onPath(0));
		synthetic::addDepthNoise(frame, 0.003, unsigned(i + 1));
		estimate = odometry.track(frame);
	}
	expectPoseNear(estimate.T_odom_camera, CPose3D(), 0.003, 0.002);
}

TEST(OpenCvOdometry, AFrameWithoutDepthIsLostAndTheCameraGoesOnAsBefore)
{
	OpenCvOdometry odometry(testOptions());
	const auto before = follow(odometry, 0, 5);
	const auto lost = odometry.track(withoutDepth(6));
	expectSound(lost);
	EXPECT_EQ(lost.status, Status::Lost);
	EXPECT_THAT(lost.reason, HasSubstr("depth"));
	expectPoseNear(lost.T_previous_camera, before.T_previous_camera, 1e-6, 1e-6);
	EXPECT_GT(lost.covariance.trace(), before.covariance.trace());
}

TEST(OpenCvOdometry, RecoversTheTruePoseAfterBlindFrames)
{
	OpenCvOdometry odometry(testOptions());
	follow(odometry, 0, 5);
	for (int i = 6; i < 9; i++) EXPECT_EQ(odometry.track(withoutDepth(i)).status, Status::Lost);
	const auto estimate = follow(odometry, 9, 9);
	EXPECT_EQ(estimate.status, Status::Tracked) << estimate.reason;
	expectPoseNear(estimate.T_odom_camera, truth(9), 0.01, 0.005);
}

TEST(OpenCvOdometry, UncertaintyGrowsWithEveryLostFrameAndShrinksAfterRecovery)
{
	OpenCvOdometry odometry(testOptions());
	follow(odometry, 0, 3);
	const double first = odometry.track(withoutDepth(4)).covariance.trace();
	const double second = odometry.track(withoutDepth(5)).covariance.trace();
	EXPECT_GT(second, first);
	EXPECT_LT(follow(odometry, 6, 7).covariance.trace(), first);
}

TEST(OpenCvOdometry, BlindFramesAtTheBeginningAreLostAtTheOrigin)
{
	OpenCvOdometry odometry(testOptions());
	const auto blind = odometry.track(withoutDepth(0));
	expectSound(blind);
	EXPECT_EQ(blind.status, Status::Lost);
	EXPECT_EQ(blind.T_odom_camera.norm(), 0);
	const auto start = odometry.track(frameOnPath(kPeriod));
	expectSound(start);
	EXPECT_EQ(start.status, Status::Lost);  // how it came here nobody measured
	EXPECT_EQ(odometry.track(frameOnPath(2 * kPeriod)).status, Status::Tracked);
}

TEST(OpenCvOdometry, ABareWallLeavesTheMotionOpen)
{
	synthetic::Scene wall;
	wall.planes.push_back({{1, 0, 0}, 1.5, {128, 128, 128}, 0, 0});
	const auto T = synthetic::lookAt({0, 0, 1}, {1.5, 0, 1});
	OpenCvOdometry odometry(testOptions());
	for (int i = 0; i < 4; i++)
	{
		auto frame = synthetic::renderFrame(wall, testCamera(), T);
		frame.time = at(i * kPeriod);
		const auto estimate = odometry.track(frame);
		expectSound(estimate);
		EXPECT_EQ(estimate.status, i == 0 ? Status::Tracked : Status::Lost);
	}
}

TEST(OpenCvOdometry, FollowsShapeWhereThereIsNoTexture)
{
	OpenCvOdometry odometry(testOptions());
	OdometryEstimate estimate;
	for (int i = 0; i < 6; i++)
	{
		auto frame = frameOnPath(i * kPeriod);
		frame.color.setTo(cv::Scalar::all(128));
		estimate = odometry.track(frame);
		expectSound(estimate);
		EXPECT_EQ(estimate.status, Status::Tracked) << estimate.reason;
	}
	expectPoseNear(estimate.T_odom_camera, truth(5), 0.02, 0.01);
}

TEST(OpenCvOdometry, AJumpIsLostAndNotBelieved)
{
	OpenCvOdometry odometry(testOptions());
	const auto before = follow(odometry, 0, 3);
	const auto away = synthetic::lookAt({-0.5, 0, 1}, {-0.5, 1.5, 0.3});
	const auto estimate = odometry.track(frameAt(4 * kPeriod, away));
	expectSound(estimate);
	EXPECT_EQ(estimate.status, Status::Lost);
	EXPECT_LT((estimate.T_odom_camera - before.T_odom_camera).norm(), 0.05);
}

TEST(OpenCvOdometry, AFastButVisibleMotionBeyondTheLimitIsLost)
{
	auto options = testOptions();
	options.maxTranslation = 0.01;
	OpenCvOdometry odometry(options);
	const CPose3D T = onPath(0);
	odometry.track(frameAt(0, T));
	const auto estimate = odometry.track(frameAt(kPeriod, T + CPose3D(0.03, 0, 0, 0, 0, 0)));
	EXPECT_EQ(estimate.status, Status::Lost);
	EXPECT_THAT(estimate.reason, HasSubstr("implausible"));
}

TEST(OpenCvOdometry, StartsAnewWhereItCannotFindBack)
{
	auto options = testOptions();
	options.restartAfter = 2;
	OpenCvOdometry odometry(options);
	follow(odometry, 0, 3);
	const auto away = synthetic::lookAt({-0.5, 0, 1}, {-0.5, 1.5, 0.3});
	for (int i = 4; i < 7; i++)
		EXPECT_EQ(odometry.track(frameAt(i * kPeriod, away)).status, Status::Lost);
	const auto estimate = odometry.track(frameAt(7 * kPeriod, away));
	expectSound(estimate);
	EXPECT_EQ(estimate.status, Status::Tracked) << estimate.reason;
	EXPECT_LT(estimate.T_previous_camera.norm(), 0.01);
}

TEST(OpenCvOdometry, AnImageOfAnotherSizeIsLostAndTheNextOneTrackedAgain)
{
	OpenCvOdometry odometry(testOptions());
	follow(odometry, 0, 2);
	auto small = synthetic::renderFrame(room(), synthetic::smallCamera(), onPath(3 * kPeriod));
	small.time = at(3 * kPeriod);
	const auto estimate = odometry.track(small);
	expectSound(estimate);
	EXPECT_EQ(estimate.status, Status::Lost);
	EXPECT_THAT(estimate.reason, HasSubstr("size"));
	EXPECT_EQ(follow(odometry, 4, 4).status, Status::Tracked);
}

TEST(OpenCvOdometry, FollowsACameraThatChangedItsSizeForGood)
{
	auto options = testOptions();
	options.restartAfter = 2;
	OpenCvOdometry odometry(options);
	follow(odometry, 0, 2);
	OdometryEstimate estimate;
	for (int i = 3; i < 8; i++)
	{
		auto small = synthetic::renderFrame(
			room(), synthetic::makeCamera(240, 180, 195), onPath(i * kPeriod));
		small.time = at(i * kPeriod);
		estimate = odometry.track(small);
		expectSound(estimate);
		EXPECT_EQ(estimate.status, i < 6 ? Status::Lost : Status::Tracked) << estimate.reason;
	}
	expectPoseNear(
		estimate.T_previous_camera, onPath(7 * kPeriod) - onPath(6 * kPeriod), 0.01, 0.005);
}

TEST(OpenCvOdometry, DamagedFramesAreLostAndNeverACrash)
{
	OpenCvOdometry odometry(testOptions());
	follow(odometry, 0, 1);

	auto noColor = frameOnPath(2 * kPeriod);
	noColor.color = cv::Mat();
	auto noDepth = frameOnPath(2 * kPeriod);
	noDepth.depth = cv::Mat();
	auto mixed = frameOnPath(2 * kPeriod);
	mixed.color = mixed.color.rowRange(0, 100).clone();
	auto noCamera = frameOnPath(2 * kPeriod);
	noCamera.camera = mrpt::img::TCamera();
	noCamera.camera.setIntrinsicParamsFromValues(0, 0, 0, 0);
	auto nan = frameOnPath(2 * kPeriod);
	nan.depth.setTo(std::numeric_limits<float>::quiet_NaN());
	auto infinite = frameOnPath(2 * kPeriod);
	infinite.depth.setTo(std::numeric_limits<float>::infinity());
	for (const auto& frame : {noColor, noDepth, mixed, noCamera, nan, infinite, RgbdFrame()})
	{
		const auto estimate = odometry.track(frame);
		expectSound(estimate);
		EXPECT_EQ(estimate.status, Status::Lost);
	}
}

TEST(OpenCvOdometry, HolesAndInfinitiesInTheDepthDoNoHarm)
{
	OpenCvOdometry odometry(testOptions());
	OdometryEstimate estimate;
	for (int i = 0; i < 5; i++)
	{
		auto frame = frameOnPath(i * kPeriod);
		frame.depth(cv::Rect(40, 40, 60, 60)).setTo(std::numeric_limits<float>::quiet_NaN());
		frame.depth(cv::Rect(200, 60, 30, 60)).setTo(std::numeric_limits<float>::infinity());
		frame.depth(cv::Rect(120, 180, 60, 30)).setTo(-1);
		estimate = odometry.track(frame);
		expectSound(estimate);
	}
	EXPECT_EQ(estimate.status, Status::Tracked) << estimate.reason;
	expectPoseNear(estimate.T_odom_camera, truth(4), 0.01, 0.005);
}

TEST(OpenCvOdometry, GivesTheSameNumbersEveryTime)
{
	OpenCvOdometry a(testOptions()), b(testOptions());
	const auto first = follow(a, 0, 4), second = follow(b, 0, 4);
	EXPECT_EQ((first.T_odom_camera.asString()), second.T_odom_camera.asString());
	EXPECT_EQ(first.T_odom_camera.x(), second.T_odom_camera.x());
	EXPECT_EQ((first.covariance - second.covariance).norm(), 0);
}

TEST(OpenCvOdometry, IsMadeByNameAndConfiguredFromItsSection)
{
	const auto odometry = makeModule<Odometry>("semloop::OpenCvOdometry", "[modules] odometry");
	mrpt::config::CConfigFileMemory config;
	config.write("odometry", "method", std::string("rgbd"));
	EXPECT_NO_THROW(odometry->configure(config, "odometry"));
}

TEST(OpenCvOdometry, RefusesAWrongConfiguration)
{
	OpenCvOdometry odometry;
	mrpt::config::CConfigFileMemory unknownKey;
	unknownKey.write("odometry", "methd", std::string("rgbd"));
	EXPECT_THROW(odometry.configure(unknownKey, "odometry"), UsageError);
	mrpt::config::CConfigFileMemory unknownMethod;
	unknownMethod.write("odometry", "method", std::string("orb"));
	EXPECT_THROW(odometry.configure(unknownMethod, "odometry"), UsageError);
	mrpt::config::CConfigFileMemory swapped;
	swapped.write("odometry", "min_depth", 5.0);
	swapped.write("odometry", "max_depth", 4.0);
	EXPECT_THROW(odometry.configure(swapped, "odometry"), UsageError);
}
}  // namespace
}  // namespace semloop::test
