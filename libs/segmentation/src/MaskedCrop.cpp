#include "MaskedCrop.h"

#include <semloop/config/Error.h>

#include <cmath>

namespace semloop
{
namespace
{
std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}
}  // namespace

MaskedCrop maskedCrop(const cv::Mat& color, const Instance& instance, const char* embedder)
{
	if (color.type() != CV_8UC3 || color.size() != instance.mask.imageSize())
		throw InputError(
			std::string(embedder) +
			": needs the colour image (8 bits a channel) that the mask of " +
			text(instance.mask.imageSize()) + " was found in, got one of " + text(color.size()));
	const cv::Rect box = instance.mask.boundingBox();
	return {color(box), instance.mask.decode(box)};
}

void normaliseLength(std::vector<float>& vector, const std::string& source)
{
	double sum = 0;
	for (const float v : vector) sum += double(v) * double(v);
	const double length = std::sqrt(sum);
	if (!std::isfinite(length) || length <= 0)
		throw InputError(source + ": the embedding is not a vector of positive, finite length");
	for (float& v : vector) v = float(v / length);
}

}  // namespace semloop
