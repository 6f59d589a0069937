#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/odometry/OpenCvOdometry.h>

#include <opencv2/core/mat.hpp>
#include <opencv2/rgbd.hpp>
#include <optional>
#include <string>

namespace semloop
{
/** Image and depth as cv::rgbd wants them; depth out of the options' range becomes NaN, since OpenCV
 *  would average a 0 into the coarser images. */
cv::Mat depthInRange(const cv::Mat& depth, double minDepth, double maxDepth);

/** T_current_reference by OpenCV with one of its costs (rgbd_icp, rgbd, icp), from a start; empty, and
 *  why, when it finds none. The options' method is not looked at. */
std::optional<mrpt::poses::CPose3D> alignWithOpenCv(
	const OpenCvOdometryOptions& options, const std::string& method,
	const mrpt::img::TCamera& camera, cv::Ptr<cv::rgbd::OdometryFrame> reference,
	cv::Ptr<cv::rgbd::OdometryFrame> current, const mrpt::poses::CPose3D& start, std::string& why);

}  // namespace semloop
