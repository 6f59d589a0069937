#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/math/TPoint3D.h>
#include <semloop/observations/InstanceMask.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace semloop
{
/** The part of a detection's mask whose depth belongs to the object. */
struct TrimmedMask
{
	InstanceMask mask;  //!< its pixels have valid depth
	std::vector<mrpt::math::TPoint3D>
		points;  //!< up to about 2000 of them, in the camera's frame [m]
	/** Pixels on both sides of the mask's border at the object's depth: whether they show the object
	 *  nobody knows. */
	cv::Mat uncertain;  //!< CV_8UC1 of box's size, not 0 = uncertain; empty: none
	cv::Rect box;

	/** Measurements that say something: the uncertain pixels are 0. Without any, shares the image. */
	cv::Mat certainDepth(const cv::Mat& depth) const;
};

/** Takes off what leaks into a mask at its border: erodes by a pixel or two (not at the image's border,
 *  not when the object is thin), cuts the depths apart at gaps wider than a quarter of the object's
 *  width, keeps the nearest piece that holds a third of the pixels (what is seen through a chair's back
 *  may be more than the chair), and clips the tails of its depths.
 *
 *  depth: CV_32FC1 [m] of the mask's size, 0 = invalid. Empty when fewer than minPixels pixels with
 *  depth in (0, maxDepth] are left. */
std::optional<TrimmedMask> trimMask(
	const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera, int minPixels,
	double maxDepth);

}  // namespace semloop
