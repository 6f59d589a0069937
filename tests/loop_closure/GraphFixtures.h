#pragma once

#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/Lie/SO.h>
#include <semloop/loop_closure/GraphMatcher.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "GraphExamples.h"

namespace semloop::fixtures
{
inline std::vector<Match> identityMatches(std::size_t size)
{
	std::vector<Match> matches;
	for (std::size_t i = 0; i < size; ++i) matches.push_back({i, i});
	return matches;
}

inline mrpt::poses::CPose3D yawPose(double x, double y, double z, double yaw)
{
	return mrpt::poses::CPose3D::FromXYZYawPitchRoll(x, y, z, yaw, 0, 0);
}

inline double rotationAngle(const mrpt::poses::CPose3D& T)
{
	return mrpt::poses::Lie::SO<3>::log(T.getRotationMatrix()).norm();
}

}  // namespace semloop::fixtures
