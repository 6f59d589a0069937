#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace semloop
{
/** A frame as direct alignment needs it. All images CV_32FC1 of one size. */
struct AlignmentImage
{
	cv::Mat intensity;                      //!< [0, 255]
	cv::Mat intensityX, intensityY;         //!< derivatives [1/px]
	cv::Mat depth;                          //!< [m], NaN = invalid
	cv::Mat depthX, depthY;                 //!< derivatives [m/px], NaN at edges
	double fx = 0, fy = 0, cx = 0, cy = 0;  //!< pinhole [px]
};

/** From an 8-bit image and its depth [m], NaN = invalid. Fills all but the camera. */
AlignmentImage makeAlignmentImage(const cv::Mat& gray, const cv::Mat& depth);

/** A pixel of the reference, as a point in space. */
struct AlignmentPoint
{
	Eigen::Vector3f p_reference;  //!< [m]
	float intensity = 0;
	bool textured = false;  //!< its brightness says something about the motion
};

/** The pixels with depth that have texture or a smooth surface around, thinned out evenly to about
 *  `count`. Empty for an image without depth. */
std::vector<AlignmentPoint> selectAlignmentPoints(const AlignmentImage& reference, int count);

}  // namespace semloop
