#include "DepthMeasurements.h"

#include <algorithm>

namespace semloop
{
namespace
{
constexpr int reach = 2;               // pixels to each side over which the slope is measured
constexpr float maxDepth = 1000;       // [m], beyond is no depth at all (infinity is not)
constexpr float edgeRatio = 0.97F;     // a neighbour nearer than this times the depth: a depth edge
constexpr float minFactor = 1.F / 16;  // of each factor of the weight

/** The region with a margin of reach pixels; 0 where nothing was measured. */
std::vector<float> validDepth(const cv::Mat& depth, const cv::Rect& region)
{
	const int width = region.width + 2 * reach;
	std::vector<float> result(static_cast<std::size_t>(width) * (region.height + 2 * reach), 0.F);
	const int left = std::max(region.x - reach, 0);
	const int right = std::min(region.x + region.width + reach, depth.cols);
	const int bottom = std::min(region.y + region.height + reach, depth.rows);
	for (int y = std::max(region.y - reach, 0); y < bottom; ++y)
	{
		const auto* const in = depth.ptr<float>(y);
		float* const out = &result[(y - region.y + reach) * width - region.x + reach];
		for (int x = left; x < right; ++x)
		{
			const float z = in[x];
			out[x] = z > VoxelProjection::nearPlane && z < maxDepth ? z : 0.F;  // NaN becomes 0
		}
	}
	return result;
}
}  // namespace

DepthMeasurements::DepthMeasurements(
	const RgbdFrame& frame, const InstanceMask& mask, const cv::Rect& region)
	: region_(region),
	  stride_(region.width + 2),
	  pixels_(static_cast<std::size_t>(stride_) * (region.height + 2))
{
	weigh(frame, validDepth(frame.depth, region));
	markMask(frame.color, mask);
	summarizeTiles();
}

void DepthMeasurements::weigh(const RgbdFrame& frame, const std::vector<float>& depth)
{
	const int width = region_.width + 2 * reach;
	const float slopeX = static_cast<float>(frame.camera.fx()) / (2 * reach);
	const float slopeY = static_cast<float>(frame.camera.fy()) / (2 * reach);
	for (int y = 0; y < region_.height; ++y)
	{
		const float* const in = &depth[(y + reach) * width + reach];
		Measurement* const out = &pixels_[(y + 1) * stride_ + 1];
		for (int x = 0; x < region_.width; ++x)
		{
			const float z = in[x];
			const auto nearer = [&](float neighbour)
			{ return (neighbour > 0) & (neighbour < edgeRatio * z); };
			const bool farSide = nearer(in[x - 1]) | nearer(in[x + 1]) | nearer(in[x - width]) |
								 nearer(in[x + width]);

			// Slope of the surface against the image plane; a gap in the depth reads as a steep one.
			const float inverse = 1 / std::max(z, VoxelProjection::nearPlane);
			const float tanX = slopeX * inverse * (in[x + reach] - in[x - reach]);
			const float tanY = slopeY * inverse * (in[x + reach * width] - in[x - reach * width]);
			const float cosSquared = 1 / (1 + tanX * tanX + tanY * tanY);
			const float distanceFactor = std::clamp(inverse * inverse, minFactor, 1.F);
			out[x].depth = farSide ? 0.F : z;
			out[x].weight = -distanceFactor * std::max(cosSquared, minFactor);
		}
	}
}

void DepthMeasurements::markMask(const cv::Mat& color, const InstanceMask& mask)
{
	if (!color.empty()) colors_.resize(3 * pixels_.size());
	for (const auto& run : mask.runs())
	{
		const int y = run.row - region_.y;
		if (y < 0 || y >= region_.height) continue;
		const int begin = std::max(run.begin - region_.x, 0);
		const int end = std::min(run.end - region_.x, region_.width);
		const int row = (y + 1) * stride_ + 1;
		for (int x = begin; x < end; ++x) pixels_[row + x].weight = -pixels_[row + x].weight;
		if (color.empty()) continue;
		const uint8_t* const bgr = color.ptr(run.row) + 3 * region_.x;
		for (int x = begin; x < end; ++x)
			for (int c = 0; c < 3; ++c) colors_[3 * (row + x) + c] = bgr[3 * x + 2 - c];
	}
}

void DepthMeasurements::summarizeTiles()
{
	tileColumns_ = (region_.width + tile - 1) / tile;
	tileRows_ = (region_.height + tile - 1) / tile;
	tileMax_.assign(static_cast<std::size_t>(tileColumns_) * tileRows_, 0.F);
	for (int y = 0; y < region_.height; ++y)
	{
		const Measurement* const row = &pixels_[(y + 1) * stride_ + 1];
		float* const out = &tileMax_[(y / tile) * tileColumns_];
		for (int x = 0; x < region_.width; ++x)
			out[x / tile] = std::max(out[x / tile], row[x].depth);
	}
}

bool DepthMeasurements::anyBeyond(const ImageBounds& bounds, float z) const
{
	// Pixels nearest to the bounds, relative to the region.
	const auto nearest = [](float a, int offset, int size)
	{
		const auto limit = static_cast<float>(size);
		return static_cast<int>(std::clamp(a + 0.5F - static_cast<float>(offset), -1.F, limit));
	};
	const int left = std::max(nearest(bounds.uMin, region_.x, region_.width), 0);
	const int right = std::min(nearest(bounds.uMax, region_.x, region_.width), region_.width - 1);
	const int top = std::max(nearest(bounds.vMin, region_.y, region_.height), 0);
	const int bottom =
		std::min(nearest(bounds.vMax, region_.y, region_.height), region_.height - 1);
	if (left > right || top > bottom) return false;
	for (int y = top / tile; y <= bottom / tile; ++y)
		for (int x = left / tile; x <= right / tile; ++x)
			if (tileMax_[y * tileColumns_ + x] > z) return true;
	return false;
}

}  // namespace semloop
