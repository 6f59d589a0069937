#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace semloop
{
/** A binary mask in an image, run-length coded: per row, the spans of set pixels.
 *
 *  Runs are sorted by (row, begin), never touch or overlap within a row, and lie inside the image.
 *  All set operations work on the runs, in time linear in their number. */
class InstanceMask
{
public:
	/** Pixels [begin, end) of a row. */
	struct Run
	{
		uint16_t row = 0;
		uint16_t begin = 0;
		uint16_t end = 0;
		bool operator==(const Run& o) const
		{
			return row == o.row && begin == o.begin && end == o.end;
		}
	};

	/** No pixel set, in an image of no size. */
	InstanceMask() = default;
	/** No pixel set. */
	explicit InstanceMask(cv::Size imageSize);
	/** From runs as they are stored; throws InputError when they break the invariant above. */
	InstanceMask(cv::Size imageSize, std::vector<Run> runs);

	/** Codes the non-zero pixels of an 8-bit image whose top left pixel lies at origin of the whole
	 *  image; what falls outside the image is cut off. */
	static InstanceMask encode(const cv::Mat& mask, cv::Point origin, cv::Size imageSize);
	/** Same, for a mask of the whole image. */
	static InstanceMask encode(const cv::Mat& mask) { return encode(mask, {0, 0}, mask.size()); }

	/** CV_8UC1 of the image's size: 255 = set. */
	cv::Mat decode() const;
	/** Only the part inside box (clipped to the image). */
	cv::Mat decode(const cv::Rect& box) const;

	cv::Size imageSize() const { return imageSize_; }
	const std::vector<Run>& runs() const { return runs_; }
	bool empty() const { return runs_.empty(); }
	/** Number of set pixels. */
	std::size_t area() const { return area_; }
	/** Smallest box holding all set pixels; empty for an empty mask. */
	cv::Rect boundingBox() const { return box_; }
	bool contains(int x, int y) const;

	bool operator==(const InstanceMask& o) const
	{
		return imageSize_ == o.imageSize_ && runs_ == o.runs_;
	}

private:
	void updateSummary();

	cv::Size imageSize_;
	std::vector<Run> runs_;
	std::size_t area_ = 0;
	cv::Rect box_;
};

/** Number of pixels set in both; throws InputError when the image sizes differ. */
std::size_t intersectionArea(const InstanceMask& a, const InstanceMask& b);

/** |a and b| / (|a| + |b| - |a and b|), in [0, 1]; 0 when both are empty. */
double intersectionOverUnion(const InstanceMask& a, const InstanceMask& b);

/** The pixels of a that are not in b. */
InstanceMask difference(const InstanceMask& a, const InstanceMask& b);

}  // namespace semloop
