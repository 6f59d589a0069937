#pragma once

#include <opencv2/core/mat.hpp>

namespace semloop
{
/** Fits an image into a network's input: scaled with its proportions kept, centred, the rest grey.
 *
 *  Coordinates are continuous, with pixel i covering [i, i + 1):  u_network = scale * u_image + offset.
 *  An image of the network's own size passes through unchanged. */
class Letterbox
{
public:
	/** Throws InputError when a size is empty. */
	Letterbox(cv::Size image, cv::Size network);

	/** The network's input; throws InputError when the image is not of the size given above. */
	cv::Mat apply(const cv::Mat& image) const;

	cv::Rect2d toImage(const cv::Rect2d& networkBox) const;
	cv::Size imageSize() const { return image_; }
	cv::Size networkSize() const { return network_; }

private:
	cv::Size image_;
	cv::Size network_;
	cv::Rect inside_;  //!< where the scaled image lies in the network's input
};

}  // namespace semloop
