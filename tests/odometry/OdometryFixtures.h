#pragma once

#include <gtest/gtest.h>
#include <mrpt/core/Clock.h>
#include <mrpt/poses/Lie/SE.h>
#include <semloop/odometry/Odometry.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "SyntheticScene.h"

namespace semloop::test
{
using mrpt::poses::CPose3D;

inline mrpt::Clock::time_point at(double seconds)
{
	return mrpt::Clock::fromDouble(1305031000 + seconds);
}

/** A corner of a room with a few boxes: every motion shows, in brightness and in shape. */
inline synthetic::Scene room()
{
	synthetic::Scene scene;
	scene.planes.push_back({{0, 0, 1}, 0, {200, 200, 200}, 0, 0.11});
	scene.planes.push_back({{1, 0, 0}, 2.5, {180, 200, 160}, 0, 0.13});
	scene.planes.push_back({{0, 1, 0}, 1.5, {160, 180, 200}, 0, 0.12});
	scene.boxes.push_back(
		{CPose3D(1.4, 0.2, 0.3, 0.4, 0, 0), {0.5, 0.4, 0.6}, {90, 200, 200}, 0, 0.07});
	scene.boxes.push_back(
		{CPose3D(1.8, -0.6, 0.5, 1, 0, 0), {0.3, 0.5, 1.0}, {200, 90, 200}, 0, 0.09});
	scene.spheres.push_back({{1.2, 0.7, 0.35}, 0.3, {200, 200, 90}, 0, 0.06});
	return scene;
}

inline mrpt::img::TCamera testCamera()
{
	return synthetic::makeCamera(320, 240, 260);
}

/** T_world_camera on a smooth path through the room, at 30 frames a second. */
inline CPose3D onPath(double seconds)
{
	const double a = 0.5 * seconds;
	return synthetic::lookAt(
		{-0.6 + 0.3 * a, 0.25 * std::sin(a), 0.9 + 0.05 * std::sin(2 * a)},
		{1.5, 0.1 + 0.2 * std::sin(0.7 * a), 0.45});
}

inline RgbdFrame frameAt(double seconds, const CPose3D& T_world_camera)
{
	auto frame = synthetic::renderFrame(room(), testCamera(), T_world_camera);
	frame.time = at(seconds);
	return frame;
}

inline RgbdFrame frameOnPath(double seconds)
{
	return frameAt(seconds, onPath(seconds));
}

inline double angleOf(const CPose3D& pose)
{
	const auto log = mrpt::poses::Lie::SE<3>::log(pose);
	return std::sqrt(log[3] * log[3] + log[4] * log[4] + log[5] * log[5]);
}

inline bool isFinite(const CPose3D& pose)
{
	for (int i = 0; i < 6; i++)
		if (!std::isfinite(pose[i])) return false;
	return true;
}

inline void expectPoseNear(
	const CPose3D& actual, const CPose3D& expected, double metres, double radians)
{
	const CPose3D difference = actual - expected;
	EXPECT_LE(difference.norm(), metres) << actual << " is not " << expected;
	EXPECT_LE(angleOf(difference), radians) << actual << " is not " << expected;
}

/** What holds for every estimate, tracked or lost. */
inline void expectSound(const OdometryEstimate& estimate)
{
	EXPECT_TRUE(isFinite(estimate.T_odom_camera));
	EXPECT_TRUE(isFinite(estimate.T_previous_camera));
	const Eigen::Matrix<double, 6, 6>& C = estimate.covariance;
	ASSERT_TRUE(C.allFinite());
	EXPECT_LT((C - C.transpose()).norm(), 1e-12 * C.norm());
	EXPECT_GT((Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(C).eigenvalues()(0)), 0);
	const bool lost = estimate.status == OdometryEstimate::Status::Lost;
	EXPECT_EQ(lost, !estimate.reason.empty());
}

}  // namespace semloop::test
