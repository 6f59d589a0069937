#pragma once

#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace semloop
{
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose);

/** With an exactly orthonormal rotation. Inverses take the transpose for granted: without this, the
 *  rounding of a long chain of products and inverses doubles with every step. */
mrpt::poses::CPose3D toPose(const Eigen::Isometry3d& T);
mrpt::poses::CPose3D orthonormalized(const mrpt::poses::CPose3D& pose);

/** Ad(T): exp(Ad(T) e) = T exp(e) T^-1, translation first. */
Matrix6 adjoint(const mrpt::poses::CPose3D& pose);

/** Covariance of log(T_a_b^-1 * truth) when that of T_o_a is in a's frame, and T_o_b is exact. */
Matrix6 covarianceSeenFrom(const mrpt::poses::CPose3D& T_a_b, const Matrix6& covarianceOfA);

/** diag(translation^2, rotation^2). */
Matrix6 diagonalCovariance(double sigmaTranslation, double sigmaRotation);

/** Angle of the rotation, in [0, pi] [rad]. */
double rotationAngle(const mrpt::poses::CPose3D& pose);

/** exp of a small motion: rotation vector in the last three, translation as it is. */
Eigen::Isometry3d smallMotion(const Eigen::Matrix<double, 6, 1>& step);

}  // namespace semloop
