#pragma once

#include <semloop/observations/InstanceMask.h>
#include <semloop/observations/RgbdFrame.h>

#include <vector>

#include "TsdfProjection.h"

namespace semloop
{
/** What one pixel says. */
struct Measurement
{
	float depth = 0;   //!< [m]; 0 = nothing
	float weight = 0;  //!< of the running average; positive in the mask, negative outside
};

/** The part of a masked depth image that matters to one object, checked and weighted (see
 *  TsdfVolume::integrate), with a border of one empty pixel. */
class DepthMeasurements
{
public:
	DepthMeasurements(const RgbdFrame& frame, const InstanceMask& mask, const cv::Rect& region);

	const cv::Rect& region() const { return region_; }
	/** Of a pixel of the image inside the region. */
	const Measurement& at(int u, int v) const
	{
		return pixels_[(v - region_.y + 1) * stride_ + (u - region_.x + 1)];
	}
	/** Row-major, stride() a row; entry (0, 0) is the border's pixel (region.x - 1, region.y - 1). */
	const Measurement* data() const { return pixels_.data(); }
	int stride() const { return stride_; }
	/** R, G, B of a masked pixel by its place in data(); nullptr without a colour image. */
	const uint8_t* color(int entry) const
	{
		return colors_.empty() ? nullptr : &colors_[3 * entry];
	}

	/** False when no pixel in the bounds measures more than depth z [m]: what is deeper is hidden. */
	bool anyBeyond(const ImageBounds& bounds, float z) const;

private:
	static constexpr int tile = 8;  // pixels

	void weigh(const RgbdFrame& frame, const std::vector<float>& depth);
	void markMask(const cv::Mat& color, const InstanceMask& mask);
	void summarizeTiles();

	cv::Rect region_;
	int stride_ = 0;
	std::vector<Measurement> pixels_;
	std::vector<uint8_t> colors_;  // of masked pixels only
	int tileColumns_ = 0, tileRows_ = 0;
	std::vector<float> tileMax_;  // largest depth in each tile of tile x tile pixels [m]
};

}  // namespace semloop
