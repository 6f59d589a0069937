#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** T_world_camera at a time. */
struct StampedPose
{
	mrpt::Clock::time_point time;
	mrpt::poses::CPose3D pose;
};

/** In order of time. */
using Trajectory = std::vector<StampedPose>;

/** Reads the TUM benchmark's format: `t tx ty tz qx qy qz qw` a line, seconds and metres, # comments.
 *  Throws InputError, naming file and line, on anything else, on a quaternion that is not of unit
 *  length within 1 %, and when time goes backwards. */
Trajectory readTumTrajectory(const std::string& path);

/** Writes it with microseconds and 9 digits; throws InputError when the file cannot be written. */
void writeTumTrajectory(const std::string& path, const Trajectory& trajectory);

/** Pose at a time: linear in the position, slerp in the rotation, between the neighbours; empty when
 *  t lies outside the trajectory or its neighbours are more than maxGap [s] apart. */
std::optional<mrpt::poses::CPose3D> interpolate(
	const Trajectory& trajectory, mrpt::Clock::time_point t, double maxGap);

}  // namespace semloop
