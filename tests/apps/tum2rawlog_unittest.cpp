#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/observations/UnixTime.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "TemporaryFolder.h"

using mrpt::obs::CObservation3DRangeScan;
using semloop::formatUnixTime;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace
{
namespace fs = std::filesystem;

const cv::Size kSize(640, 480);

cv::Mat depthImage(int seed)
{
	cv::Mat depth(kSize, CV_16UC1);
	cv::RNG(uint64_t(seed)).fill(depth, cv::RNG::UNIFORM, 0, 65536);
	depth.at<uint16_t>(0, 0) = 0;
	depth.at<uint16_t>(479, 639) = 65535;
	return depth;
}

cv::Mat colorImage(int seed)
{
	cv::Mat color(kSize, CV_8UC3);
	cv::RNG(uint64_t(seed)).fill(color, cv::RNG::UNIFORM, 0, 256);
	return color;
}

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

class Tum2Rawlog : public testing::Test
{
protected:
	/** Two pairs, a colour and a depth image without partner, accelerations around them. */
	Tum2Rawlog()
	{
		fs::create_directories(sequence_ / "rgb");
		fs::create_directories(sequence_ / "depth");
		cv::imwrite((sequence_ / "rgb/a.jpg").string(), colorImage(1));
		cv::imwrite((sequence_ / "rgb/b.png").string(), colorImage(2));
		cv::imwrite((sequence_ / "rgb/lone.png").string(), colorImage(3));
		cv::imwrite((sequence_ / "depth/a.png").string(), depthImage(1));
		cv::imwrite((sequence_ / "depth/b.png").string(), depthImage(2));
		cv::imwrite((sequence_ / "depth/lone.png").string(), depthImage(3));
		write("rgb.txt", "# colour\n10.000001 rgb/a.jpg\n10.033 rgb/b.png\n10.066 rgb/lone.png\n");
		write(
			"depth.txt",
			"# depth\n10.005 depth/a.png\n10.017 depth/lone.png\n10.032 depth/b.png\n");
		write("groundtruth.txt", "# t\n9.9 1 2 3 0 0 0 1\n10.1 1 2 4 0 0 0 1\n");
		write("accelerometer.txt", "9.5 0.1 9.7 -0.5\n10.02 0.2 9.6 -0.4\n10.9 0.3 9.5 -0.3\n");
	}

	void write(const std::string& name, const std::string& text) const
	{
		folder_.write("rgbd_dataset_freiburg1_test/" + name, text);
	}

	/** Exit code; what was printed is in out_ and err_. */
	int run(const std::string& options = "")
	{
		return runWith("'" + sequence_.string() + "' '" + rawlog_ + "' " + options);
	}
	int runWith(const std::string& arguments)
	{
		const std::string command = "'" SEMLOOP_BINARY_DIR "/bin/tum2rawlog' " + arguments +
									" > '" + folder_.file("out") + "' 2> '" + folder_.file("err") +
									"'";
		const int status = std::system(command.c_str());
		out_ = semloop::readBytes(folder_.file("out"));
		err_ = semloop::readBytes(folder_.file("err"));
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}

	/** Runs, and expects exit code 1 with one line that says all this. */
	void expectFailure(const std::vector<std::string>& saying, const std::string& options = "")
	{
		EXPECT_EQ(run(options), 1) << err_;
		EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
		for (const auto& words : saying) EXPECT_THAT(err_, HasSubstr(words));
		EXPECT_FALSE(fs::exists(rawlog_));
	}

	std::vector<mrpt::obs::CObservation::Ptr> readAll() const
	{
		semloop::RawlogReader reader(rawlog_);
		std::vector<mrpt::obs::CObservation::Ptr> all;
		while (const auto observation = reader.next()) all.push_back(observation);
		return all;
	}

	std::vector<CObservation3DRangeScan::Ptr> readScans() const
	{
		std::vector<CObservation3DRangeScan::Ptr> scans;
		for (const auto& observation : readAll())
			if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
				scans.push_back(scan);
		return scans;
	}

	const semloop::TemporaryFolder folder_;
	const fs::path sequence_ = folder_.path() / "rgbd_dataset_freiburg1_test";
	const std::string rawlog_ = folder_.file("x.rawlog");
	std::string out_, err_;
};

}  // namespace

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
	const auto bytes = [](const fs::path& path) { return semloop::readBytes(path.string()); };
	EXPECT_EQ(bytes(folder_.path() / "x_Images/color_000000.jpg"), bytes(sequence_ / "rgb/a.jpg"));
	EXPECT_EQ(bytes(folder_.path() / "x_Images/color_000001.png"), bytes(sequence_ / "rgb/b.png"));
	EXPECT_TRUE(same(semloop::rgbdFrameFrom(*readScans()[1]).color, colorImage(2)));
}

TEST_F(Tum2Rawlog, EmbeddedImagesAreLosslessAndNeedNoFolder)
{
	ASSERT_EQ(run("--embed"), 0) << err_;
	EXPECT_FALSE(fs::exists(folder_.path() / "x_Images"));
	fs::rename(sequence_, folder_.path() / "away");
	const auto scans = readScans();
	ASSERT_EQ(scans.size(), 2u);
	EXPECT_TRUE(same(storedDepth(*scans[1]), depthImage(2)));
	EXPECT_TRUE(same(semloop::rgbdFrameFrom(*scans[1]).color, colorImage(2)));
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
	const auto trajectory = semloop::readTumTrajectory(folder_.file("x_groundtruth.tum"));
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
	const auto first = semloop::readBytes(rawlog_);
	ASSERT_EQ(run(), 0) << err_;
	EXPECT_EQ(semloop::readBytes(rawlog_), first);
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

TEST_F(Tum2Rawlog, WrongUsageExitsWith2)
{
	for (const std::string options :
		 {"--camera fr9", "--max-time-difference -1", "--max-time-difference x", "--no-such-option",
		  "--max-time-difference nan"})
	{
		EXPECT_EQ(run(options), 2) << options;
		EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
	}
	EXPECT_EQ(runWith("'" + sequence_.string() + "'"), 2);
	const auto noCamera = folder_.write("bad.ini", "[A]\nfx = 3\n");
	EXPECT_EQ(run("--camera '" + noCamera + "'"), 2);
	EXPECT_THAT(err_, HasSubstr(noCamera));
	EXPECT_EQ(runWith("--help"), 0);
	EXPECT_THAT(out_, HasSubstr("--embed"));
}

TEST_F(Tum2Rawlog, AMissingFolderOrListIsNamed)
{
	fs::remove(sequence_ / "depth.txt");
	expectFailure({"depth.txt", "not there", "TUM RGB-D"});
	fs::remove(sequence_ / "rgb.txt");
	expectFailure({"rgb.txt"});
	EXPECT_EQ(runWith("/nonexistent '" + rawlog_ + "'"), 1);
	EXPECT_THAT(err_, HasSubstr("/nonexistent: no such folder"));
	EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
}

TEST_F(Tum2Rawlog, ADepthImageOf8BitsIsNamed)
{
	cv::imwrite((sequence_ / "depth/b.png").string(), cv::Mat(kSize, CV_8UC1, cv::Scalar(9)));
	expectFailure({"depth/b.png", "8 bits"});
}

TEST_F(Tum2Rawlog, AnImageOfAnotherSizeIsNamed)
{
	cv::imwrite((sequence_ / "rgb/b.png").string(), cv::Mat(240, 320, CV_8UC3, cv::Scalar(9)));
	expectFailure({"rgb/b.png", "320x240", "640x480"});
}

TEST_F(Tum2Rawlog, AMissingOrDamagedImageIsNamed)
{
	const auto path = (sequence_ / "rgb/a.jpg").string();
	const auto bytes = semloop::readBytes(path);
	write("rgb/a.jpg", bytes.substr(0, bytes.size() / 2));
	expectFailure({path, "cut"});
	fs::remove(path);
	expectFailure({path, "missing"});
}

TEST_F(Tum2Rawlog, ABadLineIsNamedWithItsNumber)
{
	write("depth.txt", "# depth\n10.005 depth/a.png\n10.01\n");
	expectFailure({"depth.txt:3: 1 columns"});
	write("depth.txt", "yesterday depth/a.png\n");
	expectFailure({"depth.txt:1: 'yesterday'"});
	write("depth.txt", "10.005 depth/a.png\n10.032 depth/b.png\n");
	write("accelerometer.txt", "9.5 0.1 9.7 -0.5\n\n9.6 0.1 nan -0.5\n");
	expectFailure({"accelerometer.txt:3: 'nan'"});
	write("accelerometer.txt", "");
	write("groundtruth.txt", "1 2 3\n");
	expectFailure({"groundtruth.txt:1: 3 columns"});
}

TEST_F(Tum2Rawlog, NoPairWithinTheTimeDifferenceIsTold)
{
	expectFailure({"--max-time-difference"}, "--max-time-difference 0.0001");
	write("rgb.txt", "# nothing\n");
	expectFailure({"rgb.txt", "no image"});
}

TEST_F(Tum2Rawlog, AnUnwritablePlaceIsTold)
{
	EXPECT_EQ(runWith("'" + sequence_.string() + "' /nonexistent/x.rawlog"), 1);
	EXPECT_THAT(err_, AllOf(HasSubstr("/nonexistent/x"), HasSubstr("cannot be written")));
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
		std::string head = semloop::readBytes((desk / (name + ".txt")).string());
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
			const auto time = semloop::parseUnixTime(file.path().stem().string()).value();
			if (std::chrono::abs(time - scans[i]->timestamp) > std::chrono::milliseconds(20))
				continue;
			found = found || same(stored, cv::imread(file.path().string(), cv::IMREAD_UNCHANGED));
		}
		EXPECT_TRUE(found) << i;
		EXPECT_GT(semloop::countValidDepth(semloop::rgbdFrameFrom(*scans[i])), 100'000);
	}
}
