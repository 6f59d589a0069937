#include <semloop/config/Error.h>
#include <semloop/observations/InstanceMask.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <tuple>

namespace semloop
{
namespace
{
using Run = InstanceMask::Run;

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void requireCodableSize(cv::Size size)
{
	constexpr int kLargest = std::numeric_limits<uint16_t>::max();
	if (size.width < 0 || size.height < 0 || size.width > kLargest || size.height > kLargest)
		throw InputError(
			"mask of " + text(size) + " pixels: both sides must lie in [0, " +
			std::to_string(kLargest) + "]");
}

void requireSameSize(const InstanceMask& a, const InstanceMask& b)
{
	if (a.imageSize() != b.imageSize())
		throw InputError(
			"masks of different images: " + text(a.imageSize()) + " and " + text(b.imageSize()) +
			" pixels");
}

bool startsBefore(const Run& a, const Run& b)
{
	return std::tie(a.row, a.begin) < std::tie(b.row, b.begin);
}

/** The run lies entirely before the other: in an earlier row or to its left. */
bool endsBefore(const Run& a, const Run& b)
{
	return a.row < b.row || (a.row == b.row && a.end <= b.begin);
}

auto firstRunInRow(const std::vector<Run>& runs, int row)
{
	return std::lower_bound(
		runs.begin(), runs.end(), row, [](const Run& run, int r) { return run.row < r; });
}

/** First non-zero pixel: zeros are skipped eight at a time, as masks are mostly zero. */
const uint8_t* findSet(const uint8_t* p, const uint8_t* last)
{
	for (uint64_t eight = 0; last - p >= 8; p += 8)
	{
		std::memcpy(&eight, p, sizeof(eight));
		if (eight != 0) break;
	}
	return std::find_if(p, last, [](uint8_t pixel) { return pixel != 0; });
}

const uint8_t* findUnset(const uint8_t* p, const uint8_t* last)
{
	const void* const found = std::memchr(p, 0, std::size_t(last - p));
	return found ? static_cast<const uint8_t*>(found) : last;
}

void appendRuns(std::vector<Run>& runs, const uint8_t* pixels, int count, int row, int column)
{
	const uint8_t* const last = pixels + count;
	for (const uint8_t* p = findSet(pixels, last); p != last; p = findSet(p, last))
	{
		const uint8_t* const end = findUnset(p, last);
		runs.push_back(
			{uint16_t(row), uint16_t(column + (p - pixels)), uint16_t(column + (end - pixels))});
		p = end;
	}
}

}  // namespace

InstanceMask::InstanceMask(cv::Size imageSize) : imageSize_(imageSize)
{
	requireCodableSize(imageSize);
}

InstanceMask::InstanceMask(cv::Size imageSize, std::vector<Run> runs)
	: imageSize_(imageSize), runs_(std::move(runs))
{
	requireCodableSize(imageSize);
	for (std::size_t i = 0; i < runs_.size(); i++)
	{
		const Run& run = runs_[i];
		const bool inside =
			run.row < imageSize.height && run.begin < run.end && run.end <= imageSize.width;
		const bool inOrder = i == 0 || runs_[i - 1].row < run.row ||
							 (runs_[i - 1].row == run.row && runs_[i - 1].end < run.begin);
		if (!inside || !inOrder)
			throw InputError(
				"mask run " + std::to_string(i) + " (row " + std::to_string(run.row) +
				", columns " + std::to_string(run.begin) + " to " + std::to_string(run.end) + ") " +
				(inside ? "touches the run before it or is out of order"
						: "is empty or outside the image of " + text(imageSize)));
	}
	updateSummary();
}

InstanceMask InstanceMask::encode(const cv::Mat& mask, cv::Point origin, cv::Size imageSize)
{
	if (!mask.empty() && mask.type() != CV_8UC1)
		throw InputError("a mask to encode must have one channel of 8 bits");

	InstanceMask coded(imageSize);
	const cv::Rect part = cv::Rect(origin, mask.size()) & cv::Rect({0, 0}, imageSize);
	for (int row = part.y; row < part.y + part.height; row++)
		appendRuns(
			coded.runs_, mask.ptr<uint8_t>(row - origin.y) + (part.x - origin.x), part.width, row,
			part.x);
	coded.updateSummary();
	return coded;
}

void InstanceMask::updateSummary()
{
	area_ = 0;
	box_ = {};
	if (runs_.empty()) return;

	int left = imageSize_.width, right = 0;
	for (const Run& run : runs_)
	{
		area_ += std::size_t(run.end - run.begin);
		left = std::min<int>(left, run.begin);
		right = std::max<int>(right, run.end);
	}
	const int top = runs_.front().row;
	box_ = {left, top, right - left, runs_.back().row + 1 - top};
}

cv::Mat InstanceMask::decode() const
{
	return decode({{0, 0}, imageSize_});
}

cv::Mat InstanceMask::decode(const cv::Rect& box) const
{
	const cv::Rect part = box & cv::Rect({0, 0}, imageSize_);
	cv::Mat mask(part.size(), CV_8UC1, cv::Scalar(0));
	const int bottom = part.y + part.height, right = part.x + part.width;
	for (auto run = firstRunInRow(runs_, part.y); run != runs_.end() && run->row < bottom; ++run)
	{
		const int begin = std::max<int>(run->begin, part.x), end = std::min<int>(run->end, right);
		if (begin >= end) continue;
		uint8_t* const pixels = mask.ptr<uint8_t>(run->row - part.y);
		std::fill(pixels + (begin - part.x), pixels + (end - part.x), uint8_t{255});
	}
	return mask;
}

bool InstanceMask::contains(int x, int y) const
{
	if (!box_.contains({x, y})) return false;
	const Run pixel{uint16_t(y), uint16_t(x), uint16_t(x)};
	const auto after = std::upper_bound(runs_.begin(), runs_.end(), pixel, startsBefore);
	if (after == runs_.begin()) return false;
	const Run& run = *std::prev(after);
	return run.row == y && x < run.end;
}

std::size_t intersectionArea(const InstanceMask& a, const InstanceMask& b)
{
	requireSameSize(a, b);
	const cv::Rect common = a.boundingBox() & b.boundingBox();
	if (common.empty()) return 0;

	std::size_t area = 0;
	auto runA = firstRunInRow(a.runs(), common.y), runB = firstRunInRow(b.runs(), common.y);
	while (runA != a.runs().end() && runB != b.runs().end())
	{
		if (runA->row == runB->row)
		{
			const int begin = std::max(runA->begin, runB->begin);
			const int end = std::min(runA->end, runB->end);
			if (begin < end) area += std::size_t(end - begin);
		}
		const bool aEndsFirst = std::tie(runA->row, runA->end) < std::tie(runB->row, runB->end);
		aEndsFirst ? ++runA : ++runB;
	}
	return area;
}

double intersectionOverUnion(const InstanceMask& a, const InstanceMask& b)
{
	const std::size_t common = intersectionArea(a, b);
	const std::size_t together = a.area() + b.area() - common;
	return together == 0 ? 0.0 : double(common) / double(together);
}

InstanceMask difference(const InstanceMask& a, const InstanceMask& b)
{
	requireSameSize(a, b);
	std::vector<Run> left;
	left.reserve(a.runs().size());
	auto cut = b.runs().begin();
	for (Run rest : a.runs())
	{
		while (cut != b.runs().end() && endsBefore(*cut, rest)) ++cut;
		// The last cut may reach into the next run of a: it is not passed here.
		for (auto c = cut; c != b.runs().end() && c->row == rest.row && c->begin < rest.end; ++c)
		{
			if (c->begin > rest.begin) left.push_back({rest.row, rest.begin, c->begin});
			rest.begin = std::min(c->end, rest.end);
		}
		if (rest.begin < rest.end) left.push_back(rest);
	}
	return InstanceMask(a.imageSize(), std::move(left));
}

}  // namespace semloop
