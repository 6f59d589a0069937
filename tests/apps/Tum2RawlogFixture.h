#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "TemporaryFolder.h"

namespace semloop::test
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

inline const cv::Size kSize(640, 480);

inline cv::Mat depthImage(int seed)
{
	cv::Mat depth(kSize, CV_16UC1);
	cv::RNG(uint64_t(seed)).fill(depth, cv::RNG::UNIFORM, 0, 65536);
	depth.at<uint16_t>(0, 0) = 0;
	depth.at<uint16_t>(479, 639) = 65535;
	return depth;
}

inline cv::Mat colorImage(int seed)
{
	cv::Mat color(kSize, CV_8UC3);
	cv::RNG(uint64_t(seed)).fill(color, cv::RNG::UNIFORM, 0, 256);
	return color;
}

/** tum2rawlog, the program, on a small sequence of noise images. */
class Tum2Rawlog : public ::testing::Test
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
		out_ = readBytes(folder_.file("out"));
		err_ = readBytes(folder_.file("err"));
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}

	/** Runs, and expects exit code 1 with one line that says all this. */
	void expectFailure(const std::vector<std::string>& saying, const std::string& options = "")
	{
		EXPECT_EQ(run(options), 1) << err_;
		EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
		for (const auto& words : saying) EXPECT_THAT(err_, ::testing::HasSubstr(words));
		EXPECT_FALSE(fs::exists(rawlog_));
	}

	std::vector<mrpt::obs::CObservation::Ptr> readAll() const
	{
		RawlogReader reader(rawlog_);
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

	const TemporaryFolder folder_;
	const fs::path sequence_ = folder_.path() / "rgbd_dataset_freiburg1_test";
	const std::string rawlog_ = folder_.file("x.rawlog");
	std::string out_, err_;
};
}  // namespace semloop::test
