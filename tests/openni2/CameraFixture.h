#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "ChildProcess.h"
#include "Shell.h"
#include "VirtualCameraFolder.h"

namespace semloop::test
{
using mrpt::obs::CObservation3DRangeScan;

inline const cv::Size kSize(64, 48);
constexpr int kFrames = 30;

/** Noise, so that no two frames and no two pixels can be taken for each other. */
inline cv::Mat colorOfFrame(int frame)
{
	cv::Mat color(kSize, CV_8UC3);
	cv::RNG(uint64_t(1000 + frame)).fill(color, cv::RNG::UNIFORM, 0, 256);
	return color;
}

/** In millimetres, less than the ten metres that a camera sees, with holes. */
inline cv::Mat depthOfFrame(int frame)
{
	cv::Mat depth(kSize, CV_16UC1);
	cv::RNG(uint64_t(2000 + frame)).fill(depth, cv::RNG::UNIFORM, 0, 10000);
	depth.row(frame % kSize.height).setTo(0);
	return depth;
}

inline mrpt::img::TCamera theCamera()
{
	mrpt::img::TCamera camera;
	camera.ncols = uint32_t(kSize.width);
	camera.nrows = uint32_t(kSize.height);
	camera.setIntrinsicParamsFromValues(52.5, 53.5, 31.5, 23.5);
	return camera;
}

/** The depth image that a scan has inside, as it is stored. */
inline cv::Mat storedDepth(const CObservation3DRangeScan& scan)
{
	cv::Mat depth(int(scan.rangeImage.rows()), int(scan.rangeImage.cols()), CV_16UC1);
	std::copy_n(scan.rangeImage.data(), depth.total(), depth.ptr<uint16_t>());
	return depth;
}

inline bool isSame(const cv::Mat& a, const cv::Mat& b)
{
	return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

/** Which frame of the camera's rawlog an image is; -1: none. */
inline int frameOfColor(const cv::Mat& color)
{
	for (int i = 0; i < kFrames; i++)
		if (isSame(color, colorOfFrame(i))) return i;
	return -1;
}
inline int frameOfDepth(const cv::Mat& depth)
{
	for (int i = 0; i < kFrames; i++)
		if (isSame(depth, depthOfFrame(i))) return i;
	return -1;
}
/** Which both are; -1: none, or not of one frame. */
inline int frameOf(const cv::Mat& color, const cv::Mat& depth)
{
	const int frame = frameOfColor(color);
	return frame == frameOfDepth(depth) ? frame : -1;
}

/** first, first + 1, ..., last */
inline std::vector<int> framesFromTo(int first, int last)
{
	std::vector<int> frames;
	for (int i = first; i <= last; i++) frames.push_back(i);
	return frames;
}

/** A rawlog for the virtual camera, in a folder of the test. */
class CameraFixture : public testing::Test
{
protected:
	CameraFixture()
	{
		RawlogWriter writer(folder_.file("camera.rawlog"));
		for (int i = 0; i < kFrames; i++)
		{
			CObservation3DRangeScan scan;
			scan.timestamp = mrpt::Clock::fromDouble(1000 + i / 30.0);
			scan.sensorLabel = "RGBD";
			scan.cameraParams = scan.cameraParamsIntensity = theCamera();
			scan.range_is_depth = true;
			scan.rangeUnits = 1e-3f;
			scan.hasRangeImage = true;
			scan.rangeImage.resize(kSize.height, kSize.width);
			const cv::Mat depth = depthOfFrame(i);
			std::copy_n(depth.ptr<uint16_t>(), depth.total(), scan.rangeImage.data());
			scan.hasIntensityImage = true;
			scan.intensityImage = mrpt::img::CImage(colorOfFrame(i), mrpt::img::DEEP_COPY);
			writer.write(scan);
		}
		writer.close();
	}

	/** Runs a command that sees the virtual camera. */
	ShellResult runWithCamera(
		const std::string& command, const std::map<std::string, std::string>& settings = {}) const
	{
		return shell(
			virtualCamera("camera.rawlog", settings) + "timeout 60 " + command, folder_.path());
	}

	/** Runs the helper with the camera; more about it in oni_recorder/main.cpp. */
	ShellResult recorder(
		const std::string& arguments,
		const std::map<std::string, std::string>& settings = {{"RATE", "100"}}) const
	{
		return runWithCamera(
			"'" SEMLOOP_BINARY_DIR "/openni2/oni-recorder' " + arguments, settings);
	}

	/** Records the camera, and returns the name of the recording. */
	std::string record(
		const std::string& what = "record",
		const std::map<std::string, std::string>& settings = {{"RATE", "100"}}) const
	{
		const auto result = recorder(what + " recorded.oni", settings);
		EXPECT_EQ(result.code, 0) << result.err;
		return folder_.file("recorded.oni");
	}

	/** Same, of a recorder that is killed while the camera stalls before frame 20. */
	std::string recordAndKill() const
	{
		const std::string path = folder_.file("killed.oni");
		ChildProcess recorder(
			{"/bin/sh", "-c",
			 "exec env " + virtualCamera(folder_.file("camera.rawlog"), {{"STALL", "20:60"}}) +
				 "'" SEMLOOP_BINARY_DIR "/openni2/oni-recorder' record '" + path + "'"},
			folder_.file("out"), folder_.file("err"));
		// Twenty frames of colour alone are as large.
		const std::size_t enough = 20 * 3 * std::size_t(kSize.area());
		waitUntil(
			"it has recorded something", [&]
			{ return std::filesystem::exists(path) && std::filesystem::file_size(path) > enough; });
		recorder.send(SIGKILL);
		EXPECT_EQ(recorder.killedBy(), SIGKILL);
		return path;
	}

	std::vector<CObservation3DRangeScan::Ptr> scansIn(const std::string& rawlog) const
	{
		std::vector<CObservation3DRangeScan::Ptr> scans;
		RawlogReader reader(rawlog);
		while (const auto observation = reader.next())
		{
			const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation);
			EXPECT_TRUE(scan) << observation->GetRuntimeClass()->className;
			if (scan) scans.push_back(scan);
		}
		return scans;
	}

	const TemporaryFolder folder_;
};

/** Which frames scans with their images inside are. */
inline std::vector<int> framesOf(const std::vector<CObservation3DRangeScan::Ptr>& scans)
{
	std::vector<int> frames;
	for (const auto& scan : scans)
		frames.push_back(frameOf(scan->intensityImage.asCvMatRef(), storedDepth(*scan)));
	return frames;
}

}  // namespace semloop::test
