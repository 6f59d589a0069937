#pragma once

#include <semloop/config/Options.h>
#include <semloop/observations/Trajectory.h>

#include <cstdint>

namespace semloop
{
/** Densities of a drift that grows with the path. */
struct OdometryNoiseOptions : Options
{
	double translation = 0.02;  //!< random walk, sigma after a metre of path [m / sqrt(m)]
	double rotation = 0.005;    //!< random walk about the vertical, after a metre [rad / sqrt(m)]
	double yawBias = 0.004;     //!< [rad / m], its sign by the seed
	double scaleBias = 0.005;   //!< relative error of the path's length, its sign by the seed
	double tilt = 0.0005;       //!< random walk of roll and pitch [rad / sqrt(m)]

protected:
	void describe(OptionFields& fields) override;
};

/** A trajectory as odometry would give it: the first pose is true, every relative motion is corrupted.
 *  Poses are T_world_camera of the optical frame, the world's z is up. A motion of length s [m] is
 *  scaled, shifted by N(0, translation^2 s) along each axis and turned about the true vertical by
 *  N(+-yawBias s, rotation^2 s), about each level axis by N(0, tilt^2 s): the error of the whole does
 *  not depend on the number of poses. Same seed, same result. */
Trajectory corruptTrajectory(
	const Trajectory& truth, const OdometryNoiseOptions& options, uint64_t seed);

}  // namespace semloop
