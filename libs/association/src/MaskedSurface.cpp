#include <semloop/association/MaskedSurface.h>
#include <semloop/config/Error.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string>

namespace semloop
{
namespace
{
constexpr float kNearest =
	0.05f;  // [m] a point closer than this, or behind the camera, is not seen

std::string text(cv::Size size)
{
	return std::to_string(size.width) + " x " + std::to_string(size.height);
}

void requireUsable(const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera)
{
	if (depth.type() != CV_32FC1)
		throw InputError("depth image: not one float a pixel; convert it to metres");
	if (depth.size() != mask.imageSize())
		throw InputError(
			"mask of a " + text(mask.imageSize()) + " image on a depth image of " +
			text(depth.size()) + "; rectify both to one size");
	if (!(camera.fx() > 0 && camera.fy() > 0))
		throw InputError("camera: focal length is not positive; calibrate it");
}

bool isDepth(float z)
{
	return z > 0 && std::isfinite(z);
}

/** The masked pixels at the middles of the grid's cells. */
std::vector<cv::Point> gridPixels(const InstanceMask& mask, int step)
{
	const cv::Rect box = mask.boundingBox();
	const int left = box.x + std::min(step, box.width) / 2;
	const int top = box.y + std::min(step, box.height) / 2;
	std::vector<cv::Point> pixels;
	for (const auto& run : mask.runs())
	{
		if (run.row < top || (run.row - top) % step != 0) continue;
		const int skipped = std::max(0, (int(run.begin) - left + step - 1) / step);
		for (int x = left + skipped * step; x < run.end; x += step)
			if (x >= run.begin) pixels.emplace_back(x, run.row);
	}
	return pixels;
}

/** Half-open box of pixels; empty when it is not in the image. */
cv::Rect clippedBox(float left, float top, float right, float bottom, cv::Size image)
{
	// Written so that NaN is outside.
	const bool inside = right > 0 && bottom > 0 && left < float(image.width) &&
						top < float(image.height) && right >= left && bottom >= top;
	if (!inside) return {};
	const int x0 = std::max(0, int(std::ceil(std::max(left, -1.0f))));
	const int y0 = std::max(0, int(std::ceil(std::max(top, -1.0f))));
	const int x1 = int(std::ceil(std::min(right, float(image.width))));
	const int y1 = int(std::ceil(std::min(bottom, float(image.height))));
	return {x0, y0, x1 - x0, y1 - y0};
}
}  // namespace

MaskedSurface::MaskedSurface(
	const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera,
	std::size_t maxSamples)
{
	if (mask.empty() || depth.empty()) return;
	requireUsable(mask, depth, camera);
	const double pixelsPerSample =
		double(mask.area()) / double(std::max<std::size_t>(1, maxSamples));
	gridStep_ = std::max(1, int(std::ceil(std::sqrt(pixelsPerSample))));
	const auto pixels = gridPixels(mask, gridStep_);

	const auto unprojected = [&](const cv::Point& pixel, float d)
	{
		return mrpt::math::TPoint3Df(
			(float(pixel.x) - float(camera.cx())) * d / float(camera.fx()),
			(float(pixel.y) - float(camera.cy())) * d / float(camera.fy()), d);
	};
	std::vector<mrpt::math::TPoint3Df> measured;
	for (const auto& pixel : pixels)
		if (const float d = depth.at<float>(pixel); isDepth(d))
			measured.push_back(unprojected(pixel, d));
	extent_ = extentOf(measured);
	if (!extent_) return;

	const auto medianDepth = float(extent_->centre.z);
	samples_.reserve(pixels.size());
	for (const auto& pixel : pixels)
	{
		const float own = depth.at<float>(pixel);
		const float d = isDepth(own) ? own : medianDepth;
		samples_.push_back({unprojected(pixel, d), float(gridStep_) * d / float(camera.fx())});
	}
}

void MaskedSurface::transform(const mrpt::poses::CPose3D& T_new_old)
{
	if (extent_) extent_->centre = T_new_old.composePoint(extent_->centre);
	const auto R = T_new_old.getRotationMatrix().cast_float();
	const mrpt::math::TPoint3Df t(float(T_new_old.x()), float(T_new_old.y()), float(T_new_old.z()));
	for (auto& sample : samples_)
	{
		const auto p = sample.point;
		sample.point = {
			R(0, 0) * p.x + R(0, 1) * p.y + R(0, 2) * p.z + t.x,
			R(1, 0) * p.x + R(1, 1) * p.y + R(1, 2) * p.z + t.y,
			R(2, 0) * p.x + R(2, 1) * p.y + R(2, 2) * p.z + t.z};
	}
}

InstanceMask MaskedSurface::project(const mrpt::img::TCamera& camera) const
{
	// Keeps the square of an unmoved point on its own pixels in spite of rounding.
	constexpr float kRounding = 1e-3f;
	const cv::Size image(int(camera.ncols), int(camera.nrows));
	const float fx = float(camera.fx()), fy = float(camera.fy());
	const float cx = float(camera.cx()), cy = float(camera.cy());

	cv::Rect all;
	std::vector<cv::Rect> squares;
	squares.reserve(samples_.size());
	for (const auto& sample : samples_)
	{
		if (!(sample.point.z > kNearest)) continue;
		const float u = fx * sample.point.x / sample.point.z + cx - kRounding;
		const float v = fy * sample.point.y / sample.point.z + cy - kRounding;
		const float halfWidth = 0.5f * sample.width * fx / sample.point.z;
		const float halfHeight = halfWidth * fy / fx;
		const cv::Rect square =
			clippedBox(u - halfWidth, v - halfHeight, u + halfWidth, v + halfHeight, image);
		if (square.empty()) continue;
		squares.push_back(square);
		all |= square;
	}
	if (squares.empty()) return InstanceMask(image);

	const int kernel = 2 * (gridStep_ / 4) + 3;
	const cv::Rect buffer(
		all.x - kernel, all.y - kernel, all.width + 2 * kernel, all.height + 2 * kernel);
	cv::Mat mask = cv::Mat::zeros(buffer.size(), CV_8UC1);
	for (const auto& square : squares)
		for (int row = 0; row < square.height; ++row)
			std::memset(
				mask.ptr(square.y - buffer.y + row) + square.x - buffer.x, 255,
				std::size_t(square.width));
	cv::morphologyEx(
		mask, mask, cv::MORPH_CLOSE, cv::getStructuringElement(cv::MORPH_RECT, {kernel, kernel}));
	return InstanceMask::encode(mask, buffer.tl(), image);
}

}  // namespace semloop
