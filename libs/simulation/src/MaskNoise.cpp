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

/** Smooth noise of variance 1: blending four numbers with the weights 3 t^2 - 2 t^3 of both axes leaves
 *  (26 / 35)^2 of their variance, on average over a cell. The key shifts the lattice, so that it is
 *  the same average everywhere. */
class SmoothNoise
{
public:
	SmoothNoise(double spacing, uint64_t key)
		: frequency_(float(1 / spacing)),
		  left_(float(uniformFrom(hashed(key, 0)))),
		  top_(float(uniformFrom(hashed(key, 1)))),
		  key_(hashed(key, 2))
	{
	}

	float operator()(int column, int row) const
	{
		constexpr float kUnit = 35.0F / 26.0F;
		const float x = float(column) * frequency_ + left_, y = float(row) * frequency_ + top_;
		const int i = int(x), j = int(y);
		const float s = x - float(i), t = y - float(j);
		const float u = s * s * (3 - 2 * s), v = t * t * (3 - 2 * t);
		const float a = node(i, j), b = node(i + 1, j), c = node(i, j + 1), d = node(i + 1, j + 1);
		const float above = a + u * (b - a), below = c + u * (d - c);
		return kUnit * (above + v * (below - above));
	}

private:
	float node(int i, int j) const { return normal_(hashed(key_, i, j)); }

	float frequency_, left_, top_;
	uint64_t key_;
	const NormalTable& normal_ = normalTable();
};

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
	const SmoothNoise noise(spacing, key);
	for (int y = 0; y < result.box.height; y++)
	{
		auto* row = result.margin.ptr<float>(y);
		for (int x = 0; x < result.box.width; x++)
		{
			if (std::abs(row[x]) >= reach) continue;
			const float shift = float(sigma) * noise(result.box.x + x, result.box.y + y);
			row[x] += std::clamp(shift, -reach, reach);
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
