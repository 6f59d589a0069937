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

/** Takes the images out of a range scan (loading external ones, and unloading them again).
 *
 *  Throws InputError when an image is missing or unreadable, the sizes of colour, depth and camera
 *  differ, depth is not along the optical axis, or colour and depth are from different places
 *  (relativePoseIntensityWRTDepth with a translation of more than a millimetre).
 *  A frame without one valid depth pixel is not an error here: callers decide. */
RgbdFrame rgbdFrameFrom(const mrpt::obs::CObservation3DRangeScan& scan);

/** Number of valid (> 0) depth pixels. */
int countValidDepth(const RgbdFrame& frame);

}  // namespace semloop
