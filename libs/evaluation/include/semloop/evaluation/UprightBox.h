#pragma once

#include <mrpt/math/TPoint3D.h>

namespace semloop
{
/** A box that stands upright, turned about the vertical. */
struct UprightBox
{
	mrpt::math::TPoint3D centre;
	mrpt::math::TVector3D size;  //!< along its own axes [m]
	double yaw = 0;              //!< of its x axis about the world's z [rad]
};

/** Whether the point is inside or on the surface. */
bool contains(const UprightBox& box, const mrpt::math::TPoint3D& point);

/** Volume of the intersection / volume of the union, in [0, 1]: area that the footprints share (one
 *  clipped at the sides of the other: Sutherland and Hodgman, CACM 17(1), 1974) times height that they
 *  share. 0 when a box is flat. */
double intersectionOverUnion(const UprightBox& a, const UprightBox& b);

}  // namespace semloop
