#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/simulation/FloorPlan.h>
#include <semloop/simulation/SceneDescription.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace semloop
{
/** The way over the floor: a centripetal Catmull-Rom spline through the waypoints (Yuksel, Schaefer and
 *  Keyser, CAD 43(7), 2011), in equal steps of at most 2 cm. Throws InputError for a way that is too
 *  short to walk. */
std::vector<Eigen::Vector2d> splineThrough(
	const std::vector<Eigen::Vector2d>& waypoints, bool closed);

/** Throws InputError, with the place, when the way leaves the rooms or comes nearer to a wall than
 *  radius [m]. */
void requireFreeWay(const std::vector<Eigen::Vector2d>& way, const FloorPlan& plan, double radius);

/** T_world_camera (optical frame) of somebody who carries a camera along the way: looks where he goes,
 *  sways to both sides, turns round at the end when he returns, and shakes. The seed chooses the
 *  phases. */
Trajectory carriedCamera(
	const std::vector<Eigen::Vector2d>& way, const PathOptions& options, double rate,
	mrpt::Clock::time_point start, uint64_t seed);

}  // namespace semloop
