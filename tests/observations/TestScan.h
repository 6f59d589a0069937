#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>
#include <opencv2/core.hpp>

namespace semloop
{
inline mrpt::img::TCamera smallCamera()
{
	mrpt::img::TCamera camera;
	camera.ncols = 64;
	camera.nrows = 48;
	camera.setIntrinsicParamsFromValues(52, 52, 31.5, 23.5);
	return camera;
}

/** A colour image in which every pixel differs in all three channels from most others. */
inline cv::Mat colorPattern(cv::Size size)
{
	cv::Mat image(size, CV_8UC3);
	for (int y = 0; y < size.height; y++)
		for (int x = 0; x < size.width; x++)
			image.at<cv::Vec3b>(y, x) = {uint8_t(3 * x), uint8_t(5 * y), uint8_t(x + y)};
	return image;
}

inline uint16_t depthPattern(int row, int column)
{
	return uint16_t(1000 * row + 7 * column);
}

/** A frame with everything inside; the depth unit is that of the TUM benchmark. */
inline mrpt::obs::CObservation3DRangeScan::Ptr makeScan(
	const mrpt::img::TCamera& camera = smallCamera())
{
	auto scan = mrpt::obs::CObservation3DRangeScan::Create();
	scan->timestamp = mrpt::Clock::fromDouble(1305031453.374112);
	scan->sensorLabel = "RGBD";
	scan->cameraParams = scan->cameraParamsIntensity = camera;
	scan->rangeUnits = 1.0f / 5000;
	scan->hasRangeImage = true;
	scan->rangeImage.resize(int(camera.nrows), int(camera.ncols));
	for (int row = 0; row < int(camera.nrows); row++)
		for (int column = 0; column < int(camera.ncols); column++)
			scan->rangeImage(row, column) = depthPattern(row, column);
	scan->hasIntensityImage = true;
	scan->intensityImage = mrpt::img::CImage(
		colorPattern({int(camera.ncols), int(camera.nrows)}), mrpt::img::DEEP_COPY);
	return scan;
}

}  // namespace semloop
