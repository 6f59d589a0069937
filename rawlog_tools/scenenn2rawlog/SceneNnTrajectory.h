#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** The camera's way, by frames of the recording. */
struct SceneNnTrajectory
{
	/** T_world_camera of the optical frame, z up; empty where the reconstruction had lost the camera. */
	std::vector<std::optional<mrpt::poses::CPose3D>> poses;

	std::optional<mrpt::poses::CPose3D> at(std::size_t frame) const
	{
		return frame < poses.size() ? poses[frame] : std::nullopt;
	}
};

/** Reads a trajectory.log: blocks of five lines, "i i i+1" with the number of the frame, from 0 on and
 *  increasing, and the four rows of T_world_camera. A block whose rotation is all zeros stands for a camera
 *  that was lost. Rotations are made exact; one that is further than 0.01 from it in an element of R^T R is
 *  none.
 *
 *  Throws InputError, naming file and line, on anything else, and when there is no pose at all. */
SceneNnTrajectory readSceneNnTrajectory(const std::string& path);

}  // namespace semloop
