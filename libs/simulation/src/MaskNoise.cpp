#include "MaskNoise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "Random.h"

namespace semloop
{
namespace
{
constexpr double kCut = 3.0;  // [sigma]

/** Smooth noise of variance 1 on average over a cell: blending four numbers with the weights
 *  3 t^2 - 2 t^3 of both axes leaves (26 / 35)^2 of their variance. */
float smoothNoise(uint64_t key, float x, float y)
{
	constexpr float kUnit = 35.0F / 26.0F;
	const NormalTable& normal = normalTable();
	const auto node = [&](int i, int j) { return normal(hashed(key, i, j)); };
	const float fx = std::floor(x), fy = std::floor(y);
	const int i = int(fx), j = int(fy);
	const float s = x - fx, t = y - fy;
	const float u = s * s * (3 - 2 * s), v = t * t * (3 - 2 * t);
	const float a = node(i, j), b = node(i + 1, j), c = node(i, j + 1), d = node(i + 1, j + 1);
	const float above = a + u * (b - a), below = c + u * (d - c);
	return kUnit * (above + v * (below - above));
}

/** Distance of a pixel's middle to the outline, which runs between the pixels; outside negative. The
 *  image's border is no outline. */
cv::Mat signedDistance(const cv::Mat& inside)
{
	cv::Mat in, out;
	cv::distanceTransform(inside, in, cv::DIST_L2, cv::DIST_MASK_3, CV_32F);
	cv::distanceTransform(inside == 0, out, cv::DIST_L2, cv::DIST_MASK_3, CV_32F);
	cv::Mat distance = in - out;
	for (int y = 0; y < distance.rows; y++)
	{
		auto* row = distance.ptr<float>(y);
		for (int x = 0; x < distance.cols; x++) row[x] -= std::copysign(0.5F, row[x]);
	}
	return distance;
}
}  // namespace

MaskMargin noisyMargin(const InstanceMask& mask, double sigma, double spacing, uint64_t key)
{
	const auto reach = float(kCut * sigma);
	const int border = sigma > 0 ? int(std::ceil(reach)) + 1 : 0;
	const cv::Rect box = mask.boundingBox();
	const cv::Rect wide(
		box.x - border, box.y - border, box.width + 2 * border, box.height + 2 * border);
	MaskMargin result{wide & cv::Rect({0, 0}, mask.imageSize()), {}};
	const cv::Mat inside = mask.decode(result.box);
	if (!(sigma > 0))
	{
		inside.convertTo(result.margin, CV_32F);
		return result;
	}
	result.margin = signedDistance(inside);
	const auto frequency = float(1 / spacing);
	for (int y = 0; y < result.box.height; y++)
	{
		auto* row = result.margin.ptr<float>(y);
		for (int x = 0; x < result.box.width; x++)
			if (std::abs(row[x]) < reach)
			{
				const float noise = float(sigma) * smoothNoise(
													   key, float(result.box.x + x) * frequency,
													   float(result.box.y + y) * frequency);
				row[x] += std::clamp(noise, -reach, reach);
			}
	}
	return result;
}

PixelClaims::PixelClaims(cv::Size imageSize)
	: best_(imageSize, CV_32FC1, cv::Scalar(0)), owner_(imageSize, CV_32SC1, cv::Scalar(-1))
{
}

void PixelClaims::take(int owner, const InstanceMask& mask)
{
	for (const auto& run : mask.runs())
		for (int x = run.begin; x < run.end; x++)
		{
			best_.at<float>(run.row, x) = std::numeric_limits<float>::infinity();
			owner_.at<int32_t>(run.row, x) = owner;
		}
}

InstanceMask PixelClaims::maskOf(int owner, const cv::Rect& box) const
{
	const cv::Mat held = owner_(box) == owner;
	return InstanceMask::encode(held, box.tl(), owner_.size());
}

}  // namespace semloop
