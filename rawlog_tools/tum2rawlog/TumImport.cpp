#include "TumImport.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "TumDirectory.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationIMU;

constexpr float kMetresPerUnit = 1.0f / 5000;  // of all depth images of the benchmark

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

cv::Mat readImage(const std::string& path, int flags, cv::Size size)
{
	const cv::Mat image = readImageFile(path, flags);
	if (image.size() != size)
		throw InputError(
			path + ": image of " + text(image.size()) + " pixels where the camera has " +
			text(size) + ": give the right one with --camera");
	return image;
}

cv::Mat readDepth(const std::string& path, cv::Size size)
{
	const cv::Mat image = readImage(path, cv::IMREAD_UNCHANGED, size);
	if (image.depth() == CV_8U)
		throw InputError(
			path + ": depth image of 8 bits: the benchmark's are PNG of 16 bits, 5000 = 1 m");
	if (image.type() != CV_16UC1)
		throw InputError(path + ": depth image must have one channel of 16 bits");
	return image;
}

void copyBytes(const std::string& from, const std::string& to)
{
	// Not copy_file(): that also copies the permissions of read-only media.
	std::ifstream in(from, std::ios::binary);
	std::ofstream out(to, std::ios::binary);
	out << in.rdbuf();
	out.close();
	if (!in || !out)
		throw InputError(to + ": cannot be written: check that the folder exists and has space");
}

/** Makes the frames of a sequence, one by one. */
class FrameMaker
{
public:
	FrameMaker(const TumImport& import)
		: import_(import), size_(int(import.camera.ncols), int(import.camera.nrows))
	{
	}

	CObservation3DRangeScan::Ptr make(
		const TumImage& color, const TumImage& depth, std::size_t number)
	{
		const cv::Mat depthImage = readDepth(depth.path, size_);
		const auto scan = rangeScanFrom(
			readImage(color.path, cv::IMREAD_COLOR, size_), depthImage, kMetresPerUnit,
			import_.camera);
		scan->timestamp = color.time;
		if (!import_.embed) moveOut(*scan, color.path, number);
		return scan;
	}

private:
	void moveOut(CObservation3DRangeScan& scan, const std::string& colorPath, std::size_t number)
	{
		if (number == 0) folder_ = beginExternalImages(import_.rawlog);
		const std::string name =
			externalImageName("color", number, fs::path(colorPath).extension().string());
		copyBytes(colorPath, (fs::path(folder_) / name).string());
		scan.intensityImage.setExternalStorage(name);
		storeDepthExternally(scan, folder_, externalImageName("depth", number, ".bin"));
	}

	const TumImport& import_;
	cv::Size size_;
	std::string folder_;
};

CObservationIMU accelerationOf(const TumAcceleration& measured)
{
	CObservationIMU imu;
	imu.timestamp = measured.time;
	imu.sensorLabel = "ACCEL";
	imu.set(mrpt::obs::IMU_X_ACC, measured.acceleration[0]);
	imu.set(mrpt::obs::IMU_Y_ACC, measured.acceleration[1]);
	imu.set(mrpt::obs::IMU_Z_ACC, measured.acceleration[2]);
	mrpt::math::CMatrixDouble33 turn;  // x left, y up, z forward -> x forward, y left, z up
	turn(0, 2) = turn(1, 0) = turn(2, 1) = 1;
	imu.sensorPose = mrpt::poses::CPose3D(turn, mrpt::math::CVectorFixedDouble<3>());
	return imu;
}

std::size_t copyGroundTruth(const std::string& from, const std::string& rawlog)
{
	if (from.empty()) return 0;
	const Trajectory trajectory = readTumTrajectory(from);
	const std::string to = fs::path(rawlog).replace_extension().string() + "_groundtruth.tum";
	writeTumTrajectory(to, trajectory);
	return trajectory.size();
}

}  // namespace

TumImportReport importTum(
	const TumImport& import, const std::function<void(std::size_t, double)>& progress)
{
	const TumDirectory directory = readTumDirectory(import.directory);
	const auto pairs = pairByTime(directory.color, directory.depth, import.maxTimeDifference);
	if (pairs.empty())
		throw InputError(
			import.directory + ": no colour and depth image are within " +
			std::to_string(import.maxTimeDifference) +
			" s of each other: give a larger --max-time-difference");

	RawlogWriter writer(import.rawlog);
	FrameMaker frames(import);
	auto acceleration = directory.accelerations.begin();
	const auto writeAccelerationsBefore = [&](mrpt::Clock::time_point time)
	{
		for (; acceleration != directory.accelerations.end() && acceleration->time < time;
			 ++acceleration)
			writer.write(accelerationOf(*acceleration));
	};
	for (std::size_t i = 0; i < pairs.size(); i++)
	{
		const TumImage& color = directory.color[pairs[i].color];
		writeAccelerationsBefore(color.time);
		writer.write(*frames.make(color, directory.depth[pairs[i].depth], i));
		progress(i + 1, double(i + 1) / double(pairs.size()));
	}
	writeAccelerationsBefore(mrpt::Clock::time_point::max());

	TumImportReport report;
	report.pairs = pairs.size();
	report.unpairedColor = directory.color.size() - pairs.size();
	report.unpairedDepth = directory.depth.size() - pairs.size();
	report.accelerations = directory.accelerations.size();
	report.groundTruthPoses = copyGroundTruth(directory.groundTruthPath, import.rawlog);
	writer.close();
	return report;
}

}  // namespace semloop
