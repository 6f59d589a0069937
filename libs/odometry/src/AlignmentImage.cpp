#include "AlignmentImage.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kBorder = 3;      // [px]
constexpr int kSlopeReach = 2;  // [px]: the depth's steps are coarser than its slope over one pixel
constexpr float kMaxSlope = 0.03f;  // of the depth, per pixel; more is an edge
constexpr float kMinGradient = 5;   // [1/px], above the noise of the camera

/** Central difference over kSlopeReach; NaN where a neighbour is invalid or beyond an edge. */
float slope(float before, float here, float after)
{
	const float limit = kMaxSlope * here * kSlopeReach;
	const bool smooth = std::abs(before - here) < limit && std::abs(after - here) < limit;
	return smooth ? (after - before) / (2 * kSlopeReach) : kNaN;
}

void depthSlopes(const cv::Mat& depth, cv::Mat& depthX, cv::Mat& depthY)
{
	depthX = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(kNaN));
	depthY = depthX.clone();
	const int r = kSlopeReach;
	for (int v = r; v < depth.rows - r; v++)
	{
		const float* row = depth.ptr<float>(v);
		const float* above = depth.ptr<float>(v - r);
		const float* below = depth.ptr<float>(v + r);
		for (int u = r; u < depth.cols - r; u++)
		{
			depthX.at<float>(v, u) = slope(row[u - r], row[u], row[u + r]);
			depthY.at<float>(v, u) = slope(above[u], row[u], below[u]);
		}
	}
}
}  // namespace

AlignmentImage makeAlignmentImage(const cv::Mat& gray, const cv::Mat& depth)
{
	AlignmentImage image;
	gray.convertTo(image.intensity, CV_32F);
	cv::Scharr(image.intensity, image.intensityX, CV_32F, 1, 0, 1.0 / 32);
	cv::Scharr(image.intensity, image.intensityY, CV_32F, 0, 1, 1.0 / 32);
	image.depth = depth;
	depthSlopes(depth, image.depthX, image.depthY);
	return image;
}

std::vector<AlignmentPoint> selectAlignmentPoints(const AlignmentImage& reference, int count)
{
	std::vector<AlignmentPoint> points;
	for (int v = kBorder; v < reference.depth.rows - kBorder; v++)
		for (int u = kBorder; u < reference.depth.cols - kBorder; u++)
		{
			const float z = reference.depth.at<float>(v, u);
			if (!std::isfinite(z)) continue;
			const float gx = reference.intensityX.at<float>(v, u);
			const float gy = reference.intensityY.at<float>(v, u);
			const bool textured = gx * gx + gy * gy > kMinGradient * kMinGradient;
			const bool smooth = std::isfinite(reference.depthX.at<float>(v, u)) &&
								std::isfinite(reference.depthY.at<float>(v, u));
			if (!textured && !smooth) continue;
			const float x = float((u - reference.cx) / reference.fx) * z;
			const float y = float((v - reference.cy) / reference.fy) * z;
			points.push_back({{x, y, z}, reference.intensity.at<float>(v, u), textured});
		}
	if (count <= 0 || points.size() <= std::size_t(count)) return points;

	std::vector<AlignmentPoint> some;
	for (int i = 0; i < count; i++)
		some.push_back(points[std::size_t(double(i) * double(points.size()) / count)]);
	return some;
}

}  // namespace semloop
