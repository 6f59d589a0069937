#pragma once

#include <mrpt/math/TPoint3D.h>

#include <optional>
#include <vector>

namespace semloop
{
/** Where a visible surface is and how large. */
struct SurfaceExtent
{
	mrpt::math::TPoint3D centre;  //!< median, each coordinate by itself [m]
	double radius = 0;            //!< median distance of the points from it [m]
};

/** Empty of no point. */
std::optional<SurfaceExtent> extentOf(const std::vector<mrpt::math::TPoint3Df>& points);

}  // namespace semloop
