#include <semloop/segmentation/Detection.h>

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
/** The two neighbouring cells of a coordinate and how much the second one counts. */
struct Neighbours
{
	int first = 0;
	int second = 0;
	float weight = 0;
};

std::vector<Neighbours> neighboursOfPixels(
	int begin, int count, double origin, double size, int cells)
{
	std::vector<Neighbours> result(static_cast<std::size_t>(count));
	for (int i = 0; i < count; i++)
	{
		const double cell = (begin + i + 0.5 - origin) / size * cells - 0.5;
		const double inside = std::clamp(cell, 0.0, cells - 1.0);
		const int first = int(inside);
		result[std::size_t(i)] = {first, std::min(first + 1, cells - 1), float(inside - first)};
	}
	return result;
}
}  // namespace

double intersectionOverUnion(const cv::Rect2d& a, const cv::Rect2d& b)
{
	const double common = (a & b).area();
	const double all = a.area() + b.area() - common;
	return all > 0 ? common / all : 0.0;
}

std::vector<Candidate> suppressNonMaxima(
	std::vector<Candidate> candidates, const DetectionLimits& limits)
{
	std::stable_sort(
		candidates.begin(), candidates.end(),
		[](const Candidate& a, const Candidate& b)
		{ return a.scores.front().score > b.scores.front().score; });

	std::vector<Candidate> kept;
	for (auto& candidate : candidates)
	{
		if (int(kept.size()) >= limits.maxDetections) break;
		const auto suppresses = [&](const Candidate& stronger)
		{
			return stronger.scores.front().label == candidate.scores.front().label &&
				   intersectionOverUnion(stronger.box, candidate.box) > limits.maxIou;
		};
		if (std::none_of(kept.begin(), kept.end(), suppresses))
			kept.push_back(std::move(candidate));
	}
	return kept;
}

cv::Rect pixelBox(const cv::Rect2d& box, cv::Size image)
{
	const auto pixel = [](double edge, int limit)
	{ return int(std::lround(std::clamp(edge, 0.0, double(limit)))); };
	return {
		cv::Point(pixel(box.x, image.width), pixel(box.y, image.height)),
		cv::Point(pixel(box.x + box.width, image.width), pixel(box.y + box.height, image.height))};
}

cv::Mat maskFromGrid(
	const cv::Mat& grid, const cv::Rect2d& extent, const cv::Rect& box, float threshold)
{
	const auto columns = neighboursOfPixels(box.x, box.width, extent.x, extent.width, grid.cols);
	const auto rows = neighboursOfPixels(box.y, box.height, extent.y, extent.height, grid.rows);
	cv::Mat mask(box.size(), CV_8UC1);
	for (int y = 0; y < box.height; y++)
	{
		const Neighbours& row = rows[std::size_t(y)];
		const auto* upper = grid.ptr<float>(row.first);
		const auto* lower = grid.ptr<float>(row.second);
		auto* out = mask.ptr<uint8_t>(y);
		for (int x = 0; x < box.width; x++)
		{
			const Neighbours& c = columns[std::size_t(x)];
			const float above = upper[c.first] + c.weight * (upper[c.second] - upper[c.first]);
			const float below = lower[c.first] + c.weight * (lower[c.second] - lower[c.first]);
			out[x] = above + row.weight * (below - above) > threshold ? 255 : 0;
		}
	}
	return mask;
}

}  // namespace semloop
