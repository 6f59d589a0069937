#pragma once

#include <mrpt/img/TCamera.h>
#include <semloop/observations/RgbdFrame.h>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace semloop
{
/** ORB features of a frame (E. Rublee, V. Rabaud, K. Konolige and G. Bradski, ICCV 2011), as a loop detector
 *  keeps them: 48 bytes each. */
struct OrbFeatures
{
	cv::Mat descriptors;                  //!< CV_8UC1, a row of 32 bytes per feature
	std::vector<Eigen::Vector2f> pixels;  //!< where they are in the rectified image
	std::vector<float> depths;            //!< along the optical axis [m]; 0 = unknown
	mrpt::img::TCamera camera;

	std::size_t size() const { return pixels.size(); }
	/** In the camera's optical frame [m]; meaningful where the depth is known. */
	Eigen::Vector3d point(std::size_t feature) const;
};

/** At most `count`, on eight scales; none where there is no texture. Throws InputError when the frame has no
 *  colour image of three channels or its depth image is of another size. */
OrbFeatures extractOrb(const RgbdFrame& frame, int count);

}  // namespace semloop
