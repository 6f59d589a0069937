#include "CvOdometry.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "PoseAlgebra.h"

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

cv::Mat toMatrix(const CPose3D& pose)
{
	cv::Mat m(4, 4, CV_64FC1);
	const Eigen::Matrix4d T = toIsometry(pose).matrix();
	for (int r = 0; r < 4; r++)
		for (int c = 0; c < 4; c++) m.at<double>(r, c) = T(r, c);
	return m;
}

/** Empty when OpenCV's result is no rigid motion. */
std::optional<CPose3D> fromMatrix(const cv::Mat& m)
{
	if (m.size() != cv::Size(4, 4) || m.type() != CV_64FC1) return std::nullopt;
	Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
	for (int r = 0; r < 3; r++)
		for (int c = 0; c < 4; c++) T(r, c) = m.at<double>(r, c);
	if (!T.matrix().allFinite()) return std::nullopt;
	if (std::abs(T.linear().determinant() - 1) > 1e-3) return std::nullopt;
	return toPose(T);
}

cv::Ptr<cv::rgbd::Odometry> makeOdometry(
	const OpenCvOdometryOptions& o, const std::string& method, const mrpt::img::TCamera& camera)
{
	const cv::Mat K =
		(cv::Mat_<double>(3, 3) << camera.fx(), 0, camera.cx(), 0, camera.fy(), camera.cy(), 0, 0,
		 1);
	const std::vector<int> iterations(std::size_t(o.pyramidLevels), o.iterations);
	const std::vector<float> gradients(std::size_t(o.pyramidLevels), 10.0f);
	const auto minDepth = float(o.minDepth), maxDepth = float(o.maxDepth),
			   difference = float(o.maxDepthDifference);
	constexpr float kPart = 0.07f;  // of the pixels, OpenCV's default

	// Our own plausibility check knows the frame rate's gaps; OpenCV's must not come first.
	const auto loosened = [](auto odometry) -> cv::Ptr<cv::rgbd::Odometry>
	{
		odometry->setMaxTranslation(10);  // [m]
		odometry->setMaxRotation(180);    // [deg]
		return odometry;
	};
	if (method == "rgbd")
		return loosened(cv::rgbd::RgbdOdometry::create(
			K, minDepth, maxDepth, difference, iterations, gradients, kPart));
	if (method == "icp")
		return loosened(
			cv::rgbd::ICPOdometry::create(K, minDepth, maxDepth, difference, kPart, iterations));
	return loosened(cv::rgbd::RgbdICPOdometry::create(
		K, minDepth, maxDepth, difference, kPart, iterations, gradients));
}
}  // namespace

cv::Mat depthInRange(const cv::Mat& depth, double minDepth, double maxDepth)
{
	cv::Mat result(depth.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
	depth.copyTo(result, (depth >= minDepth) & (depth <= maxDepth));
	return result;
}

std::optional<CPose3D> alignWithOpenCv(
	const OpenCvOdometryOptions& options, const std::string& method,
	const mrpt::img::TCamera& camera, cv::Ptr<cv::rgbd::OdometryFrame> reference,
	cv::Ptr<cv::rgbd::OdometryFrame> current, const CPose3D& start, std::string& why)
{
	cv::Mat Rt;
	bool found = false;
	try
	{
		// OpenCV's source is the reference, its destination the current frame.
		found =
			makeOdometry(options, method, camera)->compute(reference, current, Rt, toMatrix(start));
	}
	catch (const cv::Exception& e)
	{
		why = "OpenCV: " + e.err;
		return std::nullopt;
	}
	const auto T_current_reference = found ? fromMatrix(Rt) : std::nullopt;
	if (!T_current_reference) why = "OpenCV's odometry finds no motion";
	return T_current_reference;
}

}  // namespace semloop
