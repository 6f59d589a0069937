#pragma once

#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>

#include <opencv2/core/mat.hpp>
#include <optional>

namespace semloop
{
/** Takes images and masks of a camera with lens distortion to the ideal pinhole camera with the
 *  same matrix: p_u = K d^-1(K^-1 p). Colour bilinear, depth and masks nearest (a depth mixed from
 *  the two sides of an edge is a point in mid-air).
 *
 *  A camera without distortion passes through unchanged, sharing the images. The maps are computed
 *  once and kept until the camera changes. */
class Rectifier
{
public:
	/** Throws InputError when the images are not of the camera's size. */
	RgbdFrame rectify(const RgbdFrame& frame);
	/** Masks, boxes and depth crops; an instance whose mask is empty or leaves the image is dropped. */
	CObservationInstances::Ptr rectify(const CObservationInstances& observation);

private:
	void prepare(const mrpt::img::TCamera& camera);
	cv::Rect rectifiedRegion(const cv::Rect& region) const;
	std::optional<Instance> rectify(const Instance& instance) const;

	mrpt::img::TCamera camera_;
	cv::Mat map1_, map2_;  //!< as cv::initUndistortRectifyMap makes them (CV_16SC2, CV_16UC1)
	cv::Mat nearest_;      //!< CV_16SC2: source pixel of each rectified pixel, (-1, -1) outside
	cv::Mat regions_;      //!< CV_32SC4: for each block of source pixels, the box it goes to
};

/** True when the camera has a distortion model and any coefficient of it differs from 0. */
bool hasDistortion(const mrpt::img::TCamera& camera);

}  // namespace semloop
