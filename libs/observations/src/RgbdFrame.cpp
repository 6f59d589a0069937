#include <mrpt/system/filesystem.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/UnixTime.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "GzFile.h"

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

constexpr double kLargestOffset = 1e-3;         // between colour and depth camera [m]
constexpr double kLargestFocalMismatch = 0.01;  // between their intrinsics, of the focal length
constexpr float kKinectRange = 10.0f;           // [m]

[[noreturn]] void fail(const CObservation3DRangeScan& scan, const std::string& what)
{
	throw InputError(
		"frame at " + formatUnixTime(scan.timestamp) + " of sensor '" + scan.sensorLabel +
		"': " + what);
}

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

cv::Mat colorOf(const CObservation3DRangeScan& scan)
{
	if (!scan.hasIntensityImage) fail(scan, "it has no colour image");
	const mrpt::img::CImage& image = scan.intensityImage;
	if (image.isExternallyStored())
		return readImageFile(image.getExternalStorageFileAbsolutePath(), cv::IMREAD_COLOR);
	if (image.isEmpty()) fail(scan, "its colour image is empty");

	const cv::Mat& inside = image.asCvMatRef();  // MRPT keeps colours as BGR
	cv::Mat bgr;
	if (inside.type() == CV_8UC3)
		bgr = inside.clone();
	else if (inside.type() == CV_8UC1)
		cv::cvtColor(inside, bgr, cv::COLOR_GRAY2BGR);
	else if (inside.type() == CV_8UC4)
		cv::cvtColor(inside, bgr, cv::COLOR_BGRA2BGR);
	else
		fail(scan, "its colour image does not have 8 bits a channel");
	return bgr;
}

/** Text files, and the serialised float matrices of MRPT before 2.0: a class name comes first. */
bool isOldDepthFile(const std::string& path)
{
	if (mrpt::system::extractFileExtension(path, true) == "txt") return true;
	std::array<char, 4> start{};
	GzInput file(path);
	return file.read(start.data(), start.size()) == start.size() &&
		   std::all_of(
			   start.begin() + 1, start.end(), [](unsigned char c) { return std::isalpha(c); });
}

mrpt::math::CMatrix_u16 loadOldDepth(const CObservation3DRangeScan& scan, const std::string& path)
{
	try
	{
		scan.load();
		mrpt::math::CMatrix_u16 depth = scan.rangeImage;
		scan.unload();
		return depth;
	}
	catch (const std::exception&)
	{
		throw InputError(path + ": the depth image is cut or damaged");
	}
}

cv::Mat inMetres(const mrpt::math::CMatrix_u16& depth, float unit)
{
	cv::Mat metres;
	const cv::Mat values(
		int(depth.rows()), int(depth.cols()), CV_16UC1, const_cast<uint16_t*>(depth.data()));
	values.convertTo(metres, CV_32FC1, double(unit));
	return metres;
}

cv::Mat depthOf(const CObservation3DRangeScan& scan, cv::Size size)
{
	if (!scan.hasRangeImage) fail(scan, "it has no depth image");
	if (!scan.range_is_depth)
		fail(scan, "its ranges are distances, not depth along the optical axis");
	if (!(scan.rangeUnits > 0) || !std::isfinite(scan.rangeUnits))
		fail(scan, "its depth unit (rangeUnits) is not a positive number");
	if (!scan.rangeImage_isExternallyStored()) return inMetres(scan.rangeImage, scan.rangeUnits);

	const std::string path = scan.rangeImage_getExternalStorageFileAbsolutePath("");
	if (isOldDepthFile(path)) return inMetres(loadOldDepth(scan, path), scan.rangeUnits);
	return inMetres(readExternalDepth(path, size), scan.rangeUnits);
}

/** Depth must be registered to colour: one place, one set of intrinsics. */
void requireOneCamera(const CObservation3DRangeScan& scan)
{
	const auto& color = scan.cameraParamsIntensity;
	const auto& depth = scan.cameraParams;
	if (!(color.fx() > 0 && color.fy() > 0 && std::isfinite(color.fx() + color.fy()) &&
		  std::isfinite(color.cx() + color.cy())))
		fail(scan, "its camera has no valid focal length: calibrate it (cameraParamsIntensity)");

	const double offset = scan.relativePoseIntensityWRTDepth.norm();
	if (!(offset <= kLargestOffset))
		fail(
			scan, "colour and depth cameras are " + std::to_string(offset) +
					  " m apart: register depth to colour first");
	const double mismatch = std::max(
		{std::abs(color.fx() - depth.fx()), std::abs(color.fy() - depth.fy()),
		 std::abs(color.cx() - depth.cx()), std::abs(color.cy() - depth.cy())});
	if (!(mismatch <= kLargestFocalMismatch * color.fx()))
		fail(scan, "colour and depth have different intrinsics: register depth to colour first");
}

}  // namespace

RgbdFrame rgbdFrameFrom(const CObservation3DRangeScan& scan)
{
	requireOneCamera(scan);
	RgbdFrame frame;
	frame.time = scan.timestamp;
	frame.camera = scan.cameraParamsIntensity;
	frame.T_robot_camera = robotFromCamera(scan.sensorPose);
	frame.color = colorOf(scan);
	frame.depth = depthOf(scan, frame.color.size());

	const cv::Size cameraSize(int(frame.camera.ncols), int(frame.camera.nrows));
	if (frame.color.size() != cameraSize || frame.depth.size() != cameraSize)
		fail(
			scan, "sizes differ: colour " + text(frame.color.size()) + ", depth " +
					  text(frame.depth.size()) + ", camera " + text(cameraSize));
	return frame;
}

CObservation3DRangeScan::Ptr rangeScanFrom(
	const cv::Mat& color, const cv::Mat& depth, float depthUnit, const mrpt::img::TCamera& camera)
{
	auto scan = CObservation3DRangeScan::Create();
	scan->sensorLabel = "RGBD";
	scan->cameraParams = scan->cameraParamsIntensity = camera;
	scan->range_is_depth = true;
	scan->rangeUnits = depthUnit;
	scan->maxRange = kKinectRange;
	scan->hasRangeImage = true;
	scan->rangeImage.resize(depth.rows, depth.cols);
	for (int row = 0; row < depth.rows; ++row)
		std::copy_n(depth.ptr<uint16_t>(row), depth.cols, &scan->rangeImage(row, 0));
	scan->hasIntensityImage = true;
	scan->intensityImage = mrpt::img::CImage(color, mrpt::img::SHALLOW_COPY);
	return scan;
}

int countValidDepth(const RgbdFrame& frame)
{
	return cv::countNonZero(frame.depth > 0);
}

}  // namespace semloop
