#include <semloop/simulation/OdometryNoise.h>

#include <Eigen/Geometry>
#include <cmath>

#include "Random.h"

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

Eigen::Isometry3d toIsometry(const CPose3D& pose)
{
	return Eigen::Isometry3d(
		pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen().eval());
}

CPose3D toPose(const Eigen::Isometry3d& T)
{
	return CPose3D(mrpt::math::CMatrixDouble44(T.matrix()));
}

Eigen::Matrix3d rotationBy(const Eigen::Vector3d& rotationVector)
{
	const double angle = rotationVector.norm();
	if (!(angle > 0)) return Eigen::Matrix3d::Identity();
	return Eigen::AngleAxisd(angle, rotationVector / angle).toRotationMatrix();
}

/** The errors of one run, step by step. */
class Drift
{
public:
	Drift(const OdometryNoiseOptions& options, uint64_t seed)
		: options_(options), random_(hashed(seed))
	{
		scale_ = 1 + (random_.uniform() < 0.5 ? -1 : 1) * options.scaleBias;
		yawBias_ = (random_.uniform() < 0.5 ? -1 : 1) * options.yawBias;
	}

	/** T_a_b with its error; R_world_b says where b's vertical is. */
	Eigen::Isometry3d corrupted(const Eigen::Isometry3d& T_a_b, const Eigen::Matrix3d& R_world_b)
	{
		const double path = T_a_b.translation().norm();
		const double root = std::sqrt(path);
		const double tilt = options_.tilt * root;
		const Eigen::Vector3d shift = options_.translation * root * normal3();
		const Eigen::Vector3d turn = normal3();
		const Eigen::Vector3d turn_world(
			tilt * turn.x(), tilt * turn.y(),
			yawBias_ * path + options_.rotation * root * turn.z());

		Eigen::Isometry3d result = T_a_b;
		result.translation() = scale_ * T_a_b.translation() + shift;
		result.linear() = T_a_b.linear() * rotationBy(R_world_b.transpose() * turn_world);
		return result;
	}

private:
	Eigen::Vector3d normal3()
	{
		const double x = random_.normal(), y = random_.normal(), z = random_.normal();
		return {x, y, z};
	}

	OdometryNoiseOptions options_;
	RandomStream random_;
	double scale_, yawBias_;
};
}  // namespace

void OdometryNoiseOptions::describe(OptionFields& f)
{
	f.number(
		"translation", translation, 0, 10,
		"random walk along each axis, sigma after a metre of path [m / sqrt(m)]");
	f.number(
		"rotation", rotation, 0, 10,
		"random walk about the vertical, sigma after a metre [rad / sqrt(m)]");
	f.number("yaw_bias", yawBias, 0, 10, "turn about the vertical a metre of path [rad / m]");
	f.number("scale_bias", scaleBias, 0, 0.9, "relative error of the path's length");
	f.number(
		"tilt", tilt, 0, 10, "random walk about each level axis, after a metre [rad / sqrt(m)]");
}

Trajectory corruptTrajectory(
	const Trajectory& truth, const OdometryNoiseOptions& options, uint64_t seed)
{
	Trajectory result = truth;
	if (truth.empty()) return result;
	Drift drift(options, seed);
	Eigen::Isometry3d T_world_previous = toIsometry(truth.front().pose);
	Eigen::Isometry3d T_odom_camera = T_world_previous;
	for (std::size_t i = 1; i < truth.size(); i++)
	{
		const Eigen::Isometry3d T_world_camera = toIsometry(truth[i].pose);
		const Eigen::Isometry3d step = T_world_previous.inverse() * T_world_camera;
		T_odom_camera = T_odom_camera * drift.corrupted(step, T_world_camera.linear());
		T_odom_camera.linear() =
			Eigen::Quaterniond(T_odom_camera.linear()).normalized().toRotationMatrix();
		result[i].pose = toPose(T_odom_camera);
		T_world_previous = T_world_camera;
	}
	return result;
}

}  // namespace semloop
