#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/object_map/Object.h>

#include <functional>
#include <vector>

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

/** The prior, given that the query belongs to these objects of the target: seen lately, they leave less room for
 *  drift than the oldest of the map. */
using PriorOfObjects = std::function<PosePrior(const std::vector<ObjectId>&)>;

}  // namespace semloop
