#pragma once

#include <semloop/observations/CObservationInstances.h>

#include <opencv2/core/mat.hpp>

namespace semloop
{
/** An instance cut out of its image. */
struct MaskedCrop
{
	cv::Mat color;  //!< CV_8UC3, shares the image's memory
	cv::Mat mask;   //!< CV_8UC1, 255 = object
};

/** Box and mask of an instance that has any pixel; throws InputError, naming the embedder, when the
 *  image is not of 8-bit BGR and the mask's size. */
MaskedCrop maskedCrop(const cv::Mat& color, const Instance& instance, const char* embedder);

/** Divides by the length. Throws InputError when that is not a positive number. */
void normaliseLength(std::vector<float>& vector, const std::string& source);

}  // namespace semloop
