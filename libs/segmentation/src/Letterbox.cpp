#include <semloop/config/Error.h>
#include <semloop/segmentation/Letterbox.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace semloop
{
namespace
{
// What YOLO networks are padded with in training.
const cv::Scalar kPadding(114, 114, 114);

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}
}  // namespace

Letterbox::Letterbox(cv::Size image, cv::Size network) : image_(image), network_(network)
{
	if (image.empty() || network.empty())
		throw InputError(
			"cannot fit an image of " + text(image) + " into a network's input of " +
			text(network));
	const double scale =
		std::min(double(network.width) / image.width, double(network.height) / image.height);
	inside_.width = std::max(1, int(std::lround(image.width * scale)));
	inside_.height = std::max(1, int(std::lround(image.height * scale)));
	inside_.x = (network.width - inside_.width) / 2;
	inside_.y = (network.height - inside_.height) / 2;
}

cv::Mat Letterbox::apply(const cv::Mat& image) const
{
	if (image.size() != image_)
		throw InputError(
			"image of " + text(image.size()) + " where " + text(image_) + " was expected");
	if (image_ == network_) return image;

	cv::Mat result(network_, image.type(), kPadding);
	cv::Mat inside = result(inside_);
	const bool shrinks = inside_.width < image_.width;
	cv::resize(image, inside, inside_.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
	return result;
}

cv::Rect2d Letterbox::toImage(const cv::Rect2d& box) const
{
	const double scaleX = double(image_.width) / inside_.width;
	const double scaleY = double(image_.height) / inside_.height;
	return {
		(box.x - inside_.x) * scaleX, (box.y - inside_.y) * scaleY, box.width * scaleX,
		box.height * scaleY};
}

}  // namespace semloop
