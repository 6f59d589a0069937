#pragma once

#include <semloop/observations/InstanceMask.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace semloop
{
/** How far inside its outline a network sees each pixel of an image's part. */
struct MaskMargin
{
	cv::Rect box;    //!< inside the image
	cv::Mat margin;  //!< CV_32FC1 of the box's size [px]; > 0: part of the mask
};

/** The mask's signed distance to its outline plus noise of that sigma [px], cut at three sigma. The
 *  noise is smooth: numbers on a lattice with the given spacing [px], blended between (Perlin's "value
 *  noise"), so that the outline bulges rather than frays. sigma = 0: the exact mask. */
MaskMargin noisyMargin(const InstanceMask& mask, double sigma, double spacing, uint64_t key);

/** Masks that compete for the pixels of an image: each goes to the largest margin. */
class PixelClaims
{
public:
	explicit PixelClaims(cv::Size imageSize);

	/** `owner` >= 0 claims the pixels with a margin above 0 for which `part(x, y)` is true. */
	template <typename Part>
	void claim(int owner, const MaskMargin& mask, const Part& part)
	{
		for (int y = 0; y < mask.box.height; y++)
		{
			const float* margin = mask.margin.ptr<float>(y);
			float* best = best_.ptr<float>(mask.box.y + y) + mask.box.x;
			auto* holder = owner_.ptr<int32_t>(mask.box.y + y) + mask.box.x;
			for (int x = 0; x < mask.box.width; x++)
				if (margin[x] > best[x] && part(mask.box.x + x, mask.box.y + y))
				{
					best[x] = margin[x];
					holder[x] = owner;
				}
		}
	}

	/** `owner` takes them all, and nobody after it. */
	void take(int owner, const InstanceMask& mask);

	bool isFree(int x, int y) const { return owner_.at<int32_t>(y, x) < 0; }

	/** What an owner holds inside the box. */
	InstanceMask maskOf(int owner, const cv::Rect& box) const;

private:
	cv::Mat best_;   // CV_32FC1, the largest margin so far
	cv::Mat owner_;  // CV_32SC1
};

}  // namespace semloop
