#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/association/SurfaceExtent.h>
#include <semloop/observations/InstanceMask.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace semloop
{
/** The visible surface under a mask, as points on a coarse grid of its pixels: enough to say where
 *  the object's centre is and how its mask looks from a camera nearby. */
class MaskedSurface
{
public:
	/** No point. */
	MaskedSurface() = default;
	/** Unprojects about maxSamples masked pixels. One without depth takes the median depth of the
	 *  others; when none has depth the surface is empty.
	 *
	 *  depth: CV_32FC1 [m] along the optical axis, 0 or not finite = invalid, of the mask's image size,
	 *  or empty: there is none. The camera is a pinhole (distortion is not looked at). Throws
	 *  InputError when the depth image is of another type or size or the focal length not positive. */
	MaskedSurface(
		const InstanceMask& mask, const cv::Mat& depth, const mrpt::img::TCamera& camera,
		std::size_t maxSamples = 1000);

	bool empty() const { return samples_.empty(); }

	/** Of the points that have depth, in the camera's frame. */
	const std::optional<SurfaceExtent>& extent() const { return extent_; }

	/** Takes the points to another camera's frame. */
	void transform(const mrpt::poses::CPose3D& T_new_old);

	/** The mask in the picture of a camera in whose frame the points are: each point fills the square
	 *  of its grid cell at its new depth, and small holes are closed. The mask's image is the
	 *  camera's. Of an empty surface it is empty. */
	InstanceMask project(const mrpt::img::TCamera& camera) const;

private:
	struct Sample
	{
		mrpt::math::TPoint3Df point;  //!< in the camera's frame [m]
		float width = 0;              //!< side of its grid cell [m]
	};

	std::vector<Sample> samples_;
	std::optional<SurfaceExtent> extent_;
	int gridStep_ = 1;  //!< [px]
};

}  // namespace semloop
