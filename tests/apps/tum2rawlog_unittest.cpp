#include <mrpt/obs/CObservationIMU.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/observations/UnixTime.h>

#include <optional>

#include "Tum2RawlogFixture.h"

namespace semloop::test
{
namespace
{
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

bool same(const cv::Mat& a, const cv::Mat& b)
{
	return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/** Depth of a scan as it is stored. */
cv::Mat storedDepth(const CObservation3DRangeScan& scan)
{
	scan.load();
	const cv::Mat view(
		int(scan.rangeImage.rows()), int(scan.rangeImage.cols()), CV_16UC1,
		const_cast<uint16_t*>(scan.rangeImage.data()));
	return view.clone();
}

TEST_F(Tum2Rawlog, PairsOneToOneByNearestTimeAndKeepsTheTimesOfColour)
{
	ASSERT_EQ(run(), 0) << err_;
	EXPECT_EQ(err_, "");
	EXPECT_THAT(
		out_, AllOf(
				  HasSubstr("2 pairs"), HasSubstr("1 colour and 1 depth images without partner"),
				  HasSubstr("2 ground-truth poses"), HasSubstr("3 accelerations")));
	const auto scans = readScans();
	ASSERT_EQ(scans.size(), 2u);
	EXPECT_EQ(formatUnixTime(scans[0]->timestamp), "10.000001");
	EXPECT_EQ(formatUnixTime(scans[1]->timestamp), "10.033000");
	EXPECT_EQ(scans[0]->sensorLabel, "RGBD");
}

TEST_F(Tum2Rawlog, DepthIsThePngsBitByBit)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto scans = readScans();
	ASSERT_EQ(scans.size(), 2u);
	EXPECT_TRUE(scans[0]->rangeImage_isExternallyStored());
	EXPECT_TRUE(same(storedDepth(*scans[0]), depthImage(1)));
	EXPECT_TRUE(same(storedDepth(*scans[1]), depthImage(2)));
	EXPECT_FLOAT_EQ(scans[0]->rangeUnits, 1.0f / 5000);
	EXPECT_TRUE(scans[0]->range_is_depth);
}

TEST_F(Tum2Rawlog, ColourFilesAreCopiedByteByByte)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto bytes = [](const fs::path& path) { return readBytes(path.string()); };
	EXPECT_EQ(bytes(folder_.path() / "x_Images/color_000000.jpg"), bytes(sequence_ / "rgb/a.jpg"));
	EXPECT_EQ(bytes(folder_.path() / "x_Images/color_000001.png"), bytes(sequence_ / "rgb/b.png"));
	EXPECT_TRUE(same(rgbdFrameFrom(*readScans()[1]).color, colorImage(2)));
}

TEST_F(Tum2Rawlog, EmbeddedImagesAreLosslessAndNeedNoFolder)
{
	ASSERT_EQ(run("--embed"), 0) << err_;
	EXPECT_FALSE(fs::exists(folder_.path() / "x_Images"));
	fs::rename(sequence_, folder_.path() / "away");
	const auto scans = readScans();
	ASSERT_EQ(scans.size(), 2u);
	EXPECT_TRUE(same(storedDepth(*scans[1]), depthImage(2)));
	EXPECT_TRUE(same(rgbdFrameFrom(*scans[1]).color, colorImage(2)));
}

TEST_F(Tum2Rawlog, ObservationsAreInOrderOfTimeAndGravityPointsUp)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto all = readAll();
	std::vector<std::string> labels;
	for (const auto& observation : all) labels.push_back(observation->sensorLabel);
	EXPECT_EQ(labels, (std::vector<std::string>{"ACCEL", "RGBD", "ACCEL", "RGBD", "ACCEL"}));

	const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(all[0]);
	ASSERT_TRUE(imu);
	EXPECT_EQ(imu->get(mrpt::obs::IMU_Y_ACC), 9.7);
	const auto a_robot = imu->sensorPose.composePoint(mrpt::math::TPoint3D(
		imu->get(mrpt::obs::IMU_X_ACC), imu->get(mrpt::obs::IMU_Y_ACC),
		imu->get(mrpt::obs::IMU_Z_ACC)));
	EXPECT_NEAR((a_robot - mrpt::math::TPoint3D(-0.5, 0.1, 9.7)).norm(), 0, 1e-9);
}

TEST_F(Tum2Rawlog, GroundTruthIsWrittenBeside)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto trajectory = readTumTrajectory(folder_.file("x_groundtruth.tum"));
	ASSERT_EQ(trajectory.size(), 2u);
	EXPECT_EQ(trajectory[1].pose.z(), 4);
}

TEST_F(Tum2Rawlog, GroundTruthAndAccelerationsMayBeMissing)
{
	fs::remove(sequence_ / "groundtruth.txt");
	fs::remove(sequence_ / "accelerometer.txt");
	ASSERT_EQ(run(), 0) << err_;
	EXPECT_THAT(out_, AllOf(HasSubstr("0 ground-truth poses"), HasSubstr("0 accelerations")));
	EXPECT_FALSE(fs::exists(folder_.file("x_groundtruth.tum")));
}

TEST_F(Tum2Rawlog, TheSameSequenceGivesTheSameBytes)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto first = readBytes(rawlog_);
	ASSERT_EQ(run(), 0) << err_;
	EXPECT_EQ(readBytes(rawlog_), first);
}

TEST_F(Tum2Rawlog, TheFoldersNameTellsTheCamera)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto scan = readScans().at(0);
	const auto& camera = scan->cameraParams;
	EXPECT_EQ(camera.fx(), 517.3);
	EXPECT_EQ(camera.k3(), 1.1633);
	EXPECT_EQ(camera.distortion, mrpt::img::DistortionModel::plumb_bob);
	EXPECT_TRUE(scan->cameraParamsIntensity == camera);
}

TEST_F(Tum2Rawlog, AFolderWithoutSuchANameGetsTheDriversCameraAndANotice)
{
	fs::rename(sequence_, folder_.path() / "mine");
	ASSERT_EQ(runWith("'" + folder_.file("mine") + "/' '" + rawlog_ + "'"), 0) << err_;
	EXPECT_THAT(err_, HasSubstr("ros"));
	EXPECT_EQ(readScans()[0]->cameraParams.fx(), 525);
}

TEST_F(Tum2Rawlog, ACameraCanBeNamed)
{
	ASSERT_EQ(run("--camera fr3"), 0) << err_;
	EXPECT_EQ(readScans()[0]->cameraParams.fy(), 539.2);
}

TEST_F(Tum2Rawlog, ACameraFileWithAndWithoutDistortionModelIsUnderstood)
{
	const std::string common =
		"resolution = [640 480]\nfx = 500\nfy = 501\ncx = 320\ncy = 240\n"
		"dist = [0.1 -0.2 0.003 -0.004 0.05]\n";
	for (const std::string model : {"", "distortion_model = plumb_bob\n"})
	{
		const auto ini = folder_.write("camera.ini", "[MINE]\n" + common + model);
		ASSERT_EQ(run("--camera '" + ini + "'"), 0) << err_;
		const auto camera = readScans()[0]->cameraParams;
		EXPECT_EQ(camera.fy(), 501);
		EXPECT_EQ(camera.k2(), -0.2);
		EXPECT_EQ(camera.k3(), 0.05);
		EXPECT_EQ(camera.distortion, mrpt::img::DistortionModel::plumb_bob);
	}
}

TEST_F(Tum2Rawlog, WhatCalibrationProgramsWriteComesBackAsItWas)
{
	mrpt::img::TCamera camera;
	camera.setIntrinsicParamsFromValues(500, 501, 320, 240);
	camera.setDistortionPlumbBob(0.1, -0.2, 0.003, -0.004, 0.05);
	const auto ini = folder_.write("camera.ini", "[CAMERA_PARAMS]\n" + camera.dumpAsText());
	ASSERT_EQ(run("--camera '" + ini + "'"), 0) << err_;
	EXPECT_EQ(readScans()[0]->cameraParams.dist, camera.dist);
}

TEST_F(Tum2Rawlog, ARealSequenceKeepsItsDepth)
{
	const char* const data = std::getenv("SEMLOOP_DATA");
	if (!data) GTEST_SKIP() << "needs SEMLOOP_DATA";
	const fs::path desk = fs::path(data) / "data/tum_fr1_desk";
	for (const std::string name : {"rgb", "depth"})
	{
		fs::remove_all(sequence_ / name);
		fs::create_directory_symlink(fs::absolute(desk / name), sequence_ / name);
		std::string head = readBytes((desk / (name + ".txt")).string());
		std::size_t end = 0;
		for (int line = 0; line < 40; line++) end = head.find('\n', end) + 1;
		write(name + ".txt", head.substr(0, end));
	}
	ASSERT_EQ(run(), 0) << err_;
	const auto scans = readScans();
	ASSERT_GT(scans.size(), 10u);
	for (std::size_t i = 0; i < scans.size(); i += 5)
	{
		const cv::Mat stored = storedDepth(*scans[i]);
		bool found = false;  // the depth image's own name is not kept
		for (const auto& file : fs::directory_iterator(sequence_ / "depth"))
		{
			const auto time = parseUnixTime(file.path().stem().string()).value();
			if (std::chrono::abs(time - scans[i]->timestamp) > std::chrono::milliseconds(20))
				continue;
			found = found || same(stored, cv::imread(file.path().string(), cv::IMREAD_UNCHANGED));
		}
		EXPECT_TRUE(found) << i;
		EXPECT_GT(countValidDepth(rgbdFrameFrom(*scans[i])), 100'000);
	}
}
}  // namespace
}  // namespace semloop::test
