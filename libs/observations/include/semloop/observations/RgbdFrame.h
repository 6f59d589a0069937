#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/core/mat.hpp>

namespace semloop
{
/** A colour and a registered depth image of one camera. */
struct RgbdFrame
{
	mrpt::Clock::time_point time;
	cv::Mat color;  //!< CV_8UC3, BGR
	cv::Mat depth;  //!< CV_32FC1 [m] along the optical axis, 0 = invalid; same size as color
	mrpt::img::TCamera camera;  //!< of both images
	mrpt::poses::CPose3D T_robot_camera;
};

/** Copies the images out of a range scan. External ones are read from their files; the scan itself
 *  stays unloaded.
 *
 *  Throws InputError when an image is missing, unreadable or cut, the sizes of colour, depth and camera
 *  differ, depth is not along the optical axis, or depth is not registered to colour: seen from
 *  another place (relativePoseIntensityWRTDepth with a translation of more than a millimetre) or with
 *  other intrinsics (by more than 1 % of the focal length).
 *  A frame without one valid depth pixel is not an error here: callers decide. */
RgbdFrame rgbdFrameFrom(const mrpt::obs::CObservation3DRangeScan& scan);

/** The way back: a scan of colour (CV_8UC3, BGR; shared with the scan) and registered depth (CV_16UC1 of the same
 *  size, in units of depthUnit [m], 0 = invalid), both inside, as a Kinect would give it ("RGBD", 10 m far). Time
 *  and the sensor's pose are left to the caller. */
mrpt::obs::CObservation3DRangeScan::Ptr rangeScanFrom(
	const cv::Mat& color, const cv::Mat& depth, float depthUnit, const mrpt::img::TCamera& camera);

/** Number of valid (> 0) depth pixels. */
int countValidDepth(const RgbdFrame& frame);

}  // namespace semloop
