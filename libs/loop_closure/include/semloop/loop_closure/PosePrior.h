#pragma once

#include <mrpt/poses/CPose3D.h>

namespace semloop
{
/** What odometry claims for T_target_query: normally distributed about it, in the place of the query's
 *  centroid, its height and the yaw. */
struct PosePrior
{
	mrpt::poses::CPose3D T_target_query;
	double sigmaXY = 0.8;   //!< [m]
	double sigmaZ = 0.1;    //!< [m]
	double sigmaYaw = 0.1;  //!< [rad]
};

}  // namespace semloop
