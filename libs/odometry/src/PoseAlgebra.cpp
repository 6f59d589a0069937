#include "PoseAlgebra.h"

#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/math/TPoint3D.h>

#include <cmath>

namespace semloop
{
namespace
{
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v)
{
	Eigen::Matrix3d m;
	m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
	return m;
}
}  // namespace

Eigen::Isometry3d toIsometry(const mrpt::poses::CPose3D& pose)
{
	Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
	T.linear() = pose.getRotationMatrix().asEigen();
	T.translation() << pose.x(), pose.y(), pose.z();
	return T;
}

mrpt::poses::CPose3D toPose(const Eigen::Isometry3d& T)
{
	const Eigen::Matrix3d R = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
	return mrpt::poses::CPose3D::FromRotationAndTranslation(
		mrpt::math::CMatrixDouble33(R),
		mrpt::math::TPoint3D(T.translation().x(), T.translation().y(), T.translation().z()));
}

mrpt::poses::CPose3D orthonormalized(const mrpt::poses::CPose3D& pose)
{
	return toPose(toIsometry(pose));
}

Matrix6 adjoint(const mrpt::poses::CPose3D& pose)
{
	const Eigen::Isometry3d T = toIsometry(pose);
	Matrix6 m = Matrix6::Zero();
	m.topLeftCorner<3, 3>() = T.linear();
	m.bottomRightCorner<3, 3>() = T.linear();
	m.topRightCorner<3, 3>() = crossMatrix(T.translation()) * T.linear();
	return m;
}

Matrix6 covarianceSeenFrom(const mrpt::poses::CPose3D& T_a_b, const Matrix6& covarianceOfA)
{
	const Matrix6 Ad = adjoint(-T_a_b);
	return Ad * covarianceOfA * Ad.transpose();
}

Matrix6 diagonalCovariance(double sigmaTranslation, double sigmaRotation)
{
	Eigen::Matrix<double, 6, 1> variances;
	variances.head<3>().setConstant(sigmaTranslation * sigmaTranslation);
	variances.tail<3>().setConstant(sigmaRotation * sigmaRotation);
	return variances.asDiagonal();
}

double rotationAngle(const mrpt::poses::CPose3D& pose)
{
	return Eigen::AngleAxisd(toIsometry(pose).linear()).angle();
}

Eigen::Isometry3d smallMotion(const Eigen::Matrix<double, 6, 1>& step)
{
	Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
	T.translation() = step.head<3>();
	const double angle = step.tail<3>().norm();
	if (angle > 1e-12) T.linear() = Eigen::AngleAxisd(angle, step.tail<3>() / angle).matrix();
	return T;
}

}  // namespace semloop
