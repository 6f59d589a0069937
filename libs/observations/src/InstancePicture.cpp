#include <semloop/config/Error.h>
#include <semloop/observations/InstancePicture.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
constexpr double kShareOfColor = 0.55;  // of the label's colour in a mask
constexpr double kEdge = 0.6;           // brightness of a mask's edge
constexpr double kWidestName = 1.5;     // in widths of what it names

uint32_t hashOf(const std::string& text)
{
	uint32_t hash = 2166136261u;
	for (const unsigned char letter : text) hash = (hash ^ letter) * 16777619u;
	return hash;
}

cv::Mat canvasFor(const CObservationInstances& observation, const cv::Mat& color)
{
	if (color.empty()) return {observation.imageSize(), CV_8UC3, cv::Scalar::all(48)};
	if (color.type() != CV_8UC3 || color.size() != observation.imageSize())
		throw InputError("the instances are not of this image: it has another size or no colour");
	return color.clone();
}

/** Largest first: what lies on something else is drawn over it. */
std::vector<const Instance*> bySize(const std::vector<Instance>& instances)
{
	std::vector<const Instance*> order;
	for (const auto& instance : instances) order.push_back(&instance);
	std::stable_sort(
		order.begin(), order.end(),
		[](const Instance* a, const Instance* b) { return a->mask.area() > b->mask.area(); });
	return order;
}

void drawMask(cv::Mat& canvas, const InstanceMask& mask, const mrpt::img::TColor& labelColor)
{
	const cv::Vec3d color(labelColor.B, labelColor.G, labelColor.R);
	for (const auto& run : mask.runs())
		for (int x = run.begin; x < run.end; x++)
		{
			const bool inside = x > run.begin && x + 1 < run.end && mask.contains(x, run.row - 1) &&
								mask.contains(x, run.row + 1);
			cv::Vec3b& pixel = canvas.at<cv::Vec3b>(run.row, x);
			pixel = inside
						? cv::Vec3b((1 - kShareOfColor) * cv::Vec3d(pixel) + kShareOfColor * color)
						: cv::Vec3b(kEdge * color);
		}
}

void drawName(cv::Mat& canvas, const cv::Rect& box, const std::string& name)
{
	const double scale = std::max(0.3, canvas.cols / 1600.0);
	int below = 0;
	const cv::Size size = cv::getTextSize(name, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &below);
	if (size.width > kWidestName * box.width) return;
	const auto inside = [](int at, int last) { return std::clamp(at, 0, std::max(0, last)); };
	const cv::Point at(
		inside(box.x + (box.width - size.width) / 2, canvas.cols - size.width),
		size.height + inside(box.y + (box.height - size.height) / 2, canvas.rows - size.height));
	cv::putText(
		canvas, name, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(255), 3, cv::LINE_AA);
	cv::putText(
		canvas, name, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(0), 1, cv::LINE_AA);
}

}  // namespace

mrpt::img::TColor labelColor(const std::string& label)
{
	const uint32_t hash = hashOf(label);
	const double hue = (hash & 0xffff) / 65536.0, saturation = 0.6 + ((hash >> 16) & 0xff) / 850.0;
	const auto channel = [&](double shift)
	{
		// HSV with full value: how far the hue is from this channel's, in sixths of the circle.
		const double away = std::abs(std::fmod(6 * hue + shift, 6.0) - 3) - 1;
		return uint8_t(std::lround(235 * (1 - saturation * (1 - std::clamp(away, 0.0, 1.0)))));
	};
	return {channel(0), channel(4), channel(2)};
}

cv::Mat drawInstances(const CObservationInstances& observation, const cv::Mat& color)
{
	cv::Mat canvas = canvasFor(observation, color);
	const auto order = bySize(observation.instances);
	const auto nameOf = [&](const Instance& instance)
	{ return observation.labels.name(instance.label()); };
	for (const auto* instance : order)
		drawMask(canvas, instance->mask, labelColor(nameOf(*instance)));
	for (const auto* instance : order)
		drawName(canvas, instance->mask.boundingBox(), nameOf(*instance));
	return canvas;
}

}  // namespace semloop
