#include <semloop/config/Error.h>
#include <semloop/loop_closure/OrbFeatures.h>

#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace semloop
{
Eigen::Vector3d OrbFeatures::point(std::size_t feature) const
{
	const double z = depths[feature];
	const Eigen::Vector2d pixel = pixels[feature].cast<double>();
	return {
		(pixel.x() - camera.cx()) / camera.fx() * z, (pixel.y() - camera.cy()) / camera.fy() * z,
		z};
}

OrbFeatures extractOrb(const RgbdFrame& frame, int count)
{
	if (frame.color.type() != CV_8UC3 || frame.depth.type() != CV_32FC1 ||
		frame.color.size() != frame.depth.size())
		throw InputError(
			"ORB features: a colour image of three channels and a depth image of its size are "
			"needed");
	cv::Mat gray;
	cv::cvtColor(frame.color, gray, cv::COLOR_BGR2GRAY);
	std::vector<cv::KeyPoint> keyPoints;
	OrbFeatures features;
	features.camera = frame.camera;
	cv::ORB::create(count)->detectAndCompute(gray, cv::noArray(), keyPoints, features.descriptors);
	for (const cv::KeyPoint& keyPoint : keyPoints)
	{
		features.pixels.emplace_back(keyPoint.pt.x, keyPoint.pt.y);
		const float depth =
			frame.depth.at<float>(int(std::lround(keyPoint.pt.y)), int(std::lround(keyPoint.pt.x)));
		features.depths.push_back(std::isfinite(depth) && depth > 0 ? depth : 0);
	}
	return features;
}

}  // namespace semloop
