#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace semloop
{
/** A rigid motion as optimisers like it: p_target = rotation p_source + translation. */
struct RigidTransform
{
	Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  //!< unit length
	Eigen::Vector3d translation = Eigen::Vector3d::Zero();         //!< [m]

	static RigidTransform fromPose(const mrpt::poses::CPose3D& pose);
	mrpt::poses::CPose3D toPose() const;

	RigidTransform inverse() const;
	RigidTransform operator*(const RigidTransform& other) const;
};

/** Logarithm of SE(3), order (rho [m], phi [rad]): phi the rotation vector, |phi| <= pi, and
 *  translation = V(phi) rho with V = I + (1 - cos|phi|) / |phi|^2 phi^ + (|phi| - sin|phi|) / |phi|^3 phi^2
 *  (J. Sola et al., "A micro Lie theory for state estimation in robotics", 2018, Eq. (173)).
 *  mrpt::poses::Lie::SE<3>::log has the same order and rotation, but leaves the translation as it is. */
Vector6 logarithm(const RigidTransform& T);

/** Inverse of logarithm(). */
RigidTransform exponential(const Vector6& xi);

/** Inverse right Jacobian of SE(3) at xi = logarithm(T): logarithm(T exp(d)) = xi + J_r^-1(xi) d + O(d^2)
 *  (T. Barfoot, "State Estimation for Robotics", 2017, Eqs. (7.85), (7.86), in our order). */
Matrix6 inverseRightJacobian(const Vector6& xi);

/** Adjoint of T: T exp(d) T^-1 = exp(Ad_T d). */
Matrix6 adjoint(const RigidTransform& T);

/** e = log(Z_a_b^-1 T_world_a^-1 T_world_b), the residual of an edge before whitening, Eq. (7).
 *  The Jacobians, where asked for, are with respect to d in T_world_a exp(d) and T_world_b exp(d):
 *  de/da = -J_r^-1(e) Ad(T_world_b^-1 T_world_a), de/db = J_r^-1(e). */
Vector6 poseResidual(
	const RigidTransform& Z_a_b, const RigidTransform& T_world_a, const RigidTransform& T_world_b,
	Matrix6* jacobianA = nullptr, Matrix6* jacobianB = nullptr);

}  // namespace semloop
