#include "MaskTrimming.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace semloop
{
namespace
{
constexpr double kBinSize = 0.01;  // of the depth histogram [m]
constexpr std::size_t kMaxPoints = 2000;

struct DepthRange
{
	float nearest = 0, farthest = 0;  // [m]
};

struct ErodedMask
{
	cv::Rect box;    // in the image, with room for the border
	cv::Mat pixels;  // what is certainly inside
	cv::Mat border;  // what may be in or out; empty when the object is too small or thin to tell
};

ErodedMask erodedMask(const InstanceMask& mask)
{
	const double side = std::sqrt(double(mask.area()));
	const int radius = side < 24 ? 0 : side < 96 ? 1 : 2;
	const cv::Rect image(cv::Point(), mask.imageSize());
	const cv::Rect tight = mask.boundingBox();
	ErodedMask result;
	result.box = image & cv::Rect(
							 tight.x - radius, tight.y - radius, tight.width + 2 * radius,
							 tight.height + 2 * radius);
	result.pixels = mask.decode(result.box);
	if (radius == 0) return result;
	// OpenCV takes what lies outside of the matrix for mask when eroding, for none when dilating: the
	// image's own border is no border of the object.
	const cv::Mat element =
		cv::getStructuringElement(cv::MORPH_RECT, {2 * radius + 1, 2 * radius + 1});
	cv::Mat eroded;
	cv::erode(result.pixels, eroded, element);
	if (std::size_t(cv::countNonZero(eroded)) < mask.area() / 2) return result;
	cv::dilate(result.pixels, result.border, element);
	result.border.setTo(0, eroded);
	result.pixels = eroded;
	return result;
}

std::vector<int> depthHistogram(
	const cv::Mat& pixels, const cv::Rect& box, const cv::Mat& depth, double maxDepth)
{
	std::vector<int> histogram(std::size_t(maxDepth / kBinSize) + 1, 0);
	for (int v = 0; v < box.height; ++v)
	{
		const auto* set = pixels.ptr<uint8_t>(v);
		const auto* z = depth.ptr<float>(box.y + v) + box.x;
		for (int u = 0; u < box.width; ++u)
			if (set[u] && z[u] > 0 && z[u] <= maxDepth) ++histogram[std::size_t(z[u] / kBinSize)];
	}
	return histogram;
}

/** First bin at which more than this many entries of bins [first, last] are behind us. */
int quantileBin(const std::vector<int>& histogram, int first, int last, int count)
{
	for (int bin = first; bin < last; ++bin)
		if ((count -= histogram[std::size_t(bin)]) < 0) return bin;
	return last;
}

struct Piece
{
	int first = 0, last = 0;  // bins, both included
	int count = 0;
};

/** Runs of the histogram without a gap wider than the tolerance (in bins, growing with the depth:
 *  the sensor's own steps are about 3.2 mm z^2). Bins of less than a thousandth count as empty. */
std::vector<Piece> splitAtGaps(const std::vector<int>& histogram, int total, double tolerance)
{
	std::vector<Piece> pieces;
	for (int bin = 0; bin < int(histogram.size()); ++bin)
	{
		const int count = histogram[std::size_t(bin)];
		if (count <= total / 1000) continue;
		const double z = bin * kBinSize;
		const double gap = std::max(tolerance, 0.01 * z * z) / kBinSize;
		if (pieces.empty() || bin - pieces.back().last > gap) pieces.push_back({bin, bin, 0});
		pieces.back().last = bin;
		pieces.back().count += count;
	}
	return pieces;
}

std::optional<DepthRange> objectDepths(
	const std::vector<int>& histogram, const cv::Rect& box, double focalLength, int minPixels)
{
	int total = 0;
	for (const int count : histogram) total += count;
	if (total < std::max(1, minPixels)) return {};
	const double median =
		kBinSize * quantileBin(histogram, 0, int(histogram.size()) - 1, total / 2);
	const double width = median * std::max(box.width, box.height) / focalLength;

	const auto pieces = splitAtGaps(histogram, total, std::max(0.03, 0.25 * width));
	if (pieces.empty()) return {};
	const auto byCount = [](const Piece& a, const Piece& b) { return a.count < b.count; };
	auto chosen = std::find_if(
		pieces.begin(), pieces.end(), [&](const Piece& p) { return p.count >= total / 3; });
	if (chosen == pieces.end()) chosen = std::max_element(pieces.begin(), pieces.end(), byCount);

	const int tail = chosen->count / 20;
	const int lower = quantileBin(histogram, chosen->first, chosen->last, tail);
	const int upper = quantileBin(histogram, chosen->first, chosen->last, chosen->count - tail - 1);
	const double margin = 0.02 + 0.15 * width;
	return DepthRange{float(lower * kBinSize - margin), float((upper + 1) * kBinSize + margin)};
}
std::vector<mrpt::math::TPoint3D> samplePoints(
	const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera)
{
	std::vector<mrpt::math::TPoint3D> points;
	const std::size_t step = 1 + mask.area() / kMaxPoints;
	std::size_t next = 0;  // pixels to pass over before the next sample
	for (const auto& run : mask.runs())
	{
		std::size_t u = run.begin + next;
		for (; u < run.end; u += step)
		{
			const double z = depth.at<float>(run.row, int(u));
			points.emplace_back(
				z * (double(u) - camera.cx()) / camera.fx(),
				z * (run.row - camera.cy()) / camera.fy(), z);
		}
		next = u - run.end;
	}
	return points;
}
}  // namespace

cv::Mat TrimmedMask::certainDepth(const cv::Mat& depth) const
{
	if (uncertain.empty()) return depth;
	cv::Mat certain = depth.clone();
	certain(box).setTo(0, uncertain);
	return certain;
}

std::optional<TrimmedMask> trimMask(
	const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera, int minPixels,
	double maxDepth)
{
	if (mask.area() < std::size_t(std::max(1, minPixels))) return {};
	auto [box, pixels, border] = erodedMask(mask);
	const auto histogram = depthHistogram(pixels, box, depth, maxDepth);
	const auto range = objectDepths(histogram, box, camera.fx(), minPixels);
	if (!range) return {};

	const float farthest = std::min(range->farthest, float(maxDepth));
	for (int v = 0; v < box.height; ++v)
	{
		auto* inside = pixels.ptr<uint8_t>(v);
		auto* uncertain = border.empty() ? nullptr : border.ptr<uint8_t>(v);
		const auto* z = depth.ptr<float>(box.y + v) + box.x;
		for (int u = 0; u < box.width; ++u)
		{
			if (z[u] > 0 && z[u] >= range->nearest && z[u] <= farthest) continue;
			inside[u] = 0;
			if (uncertain) uncertain[u] = 0;
		}
	}
	TrimmedMask result;
	result.mask = InstanceMask::encode(pixels, box.tl(), mask.imageSize());
	if (result.mask.area() < std::size_t(std::max(1, minPixels))) return {};
	result.points = samplePoints(result.mask, depth, camera);
	result.uncertain = border;
	result.box = box;
	return result;
}

}  // namespace semloop
