#include <semloop/pose_graph/PoseResidual.h>

#include <cmath>

namespace semloop
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Below this angle the closed forms lose digits to cancellation and series take over [rad].
constexpr double kSmallAngle = 0.1;

Matrix3d skew(const Vector3d& v)
{
	Matrix3d m;
	m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
	return m;
}

/** The coefficients of phi^, phi^2 and the higher products in exp and its Jacobians. */
struct Coefficients
{
	double a;        //!< (1 - cos t) / t^2
	double b;        //!< (t - sin t) / t^3
	double c;        //!< (t^2 + 2 cos t - 2) / (2 t^4)
	double d;        //!< (2 t - 3 sin t + t cos t) / (2 t^5)
	double inverse;  //!< (1 - t/2 cot(t/2)) / t^2, in V^-1 = I - phi^/2 + inverse phi^2
};

Coefficients coefficients(double t)
{
	const double t2 = t * t;
	if (t < kSmallAngle)
	{
		const double t4 = t2 * t2;
		return {
			1. / 2 - t2 / 24 + t4 / 720 - t4 * t2 / 40320, 1. / 6 - t2 / 120 + t4 / 5040,
			1. / 24 - t2 / 720 + t4 / 40320, 1. / 120 - t2 / 2520 + t4 / 120960,
			1. / 12 + t2 / 720 + t4 / 30240};
	}
	const double sine = std::sin(t), cosine = std::cos(t);
	return {
		(1 - cosine) / t2, (t - sine) / (t2 * t), (t2 + 2 * cosine - 2) / (2 * t2 * t2),
		(2 * t - 3 * sine + t * cosine) / (2 * t2 * t2 * t), (1 - t / 2 / std::tan(t / 2)) / t2};
}

Vector3d rotationVector(const Eigen::Quaterniond& q)
{
	// q and -q are one rotation: the half with w >= 0 has |phi| <= pi.
	const double sign = q.w() < 0 ? -1.0 : 1.0;
	const double sine = q.vec().norm();
	const double cosine = sign * q.w();
	if (sine < 1e-9) return sign * 2.0 / cosine * q.vec();
	return sign * 2.0 * std::atan2(sine, cosine) / sine * q.vec();
}
}  // namespace

RigidTransform RigidTransform::fromPose(const mrpt::poses::CPose3D& pose)
{
	RigidTransform T;
	T.rotation = Eigen::Quaterniond(Matrix3d(pose.getRotationMatrix().asEigen())).normalized();
	T.translation = {pose.x(), pose.y(), pose.z()};
	return T;
}

mrpt::poses::CPose3D RigidTransform::toPose() const
{
	return mrpt::poses::CPose3D::FromRotationAndTranslation(
		Matrix3d(rotation.normalized().toRotationMatrix()), translation);
}

RigidTransform RigidTransform::inverse() const
{
	const Eigen::Quaterniond back = rotation.conjugate();
	return {back, -(back * translation)};
}

RigidTransform RigidTransform::operator*(const RigidTransform& other) const
{
	return {rotation * other.rotation, rotation * other.translation + translation};
}

Vector6 logarithm(const RigidTransform& T)
{
	const Vector3d phi = rotationVector(T.rotation);
	const Vector3d& t = T.translation;
	const Vector3d phi_t = phi.cross(t);
	Vector6 xi;
	xi << t - 0.5 * phi_t + coefficients(phi.norm()).inverse * phi.cross(phi_t), phi;
	return xi;
}

RigidTransform exponential(const Vector6& xi)
{
	const Vector3d rho = xi.head<3>(), phi = xi.tail<3>();
	const double angle = phi.norm();
	const Coefficients k = coefficients(angle);
	const double half = angle / 2;
	const double sinc = half < 1e-5 ? 0.5 - half * half / 12 : std::sin(half) / angle;

	RigidTransform T;
	T.rotation.w() = std::cos(half);
	T.rotation.vec() = sinc * phi;
	const Vector3d phi_rho = phi.cross(rho);
	T.translation = rho + k.a * phi_rho + k.b * phi.cross(phi_rho);
	return T;
}

Matrix6 inverseRightJacobian(const Vector6& xi)
{
	// J_r(xi) = J_l(-xi): the left Jacobian's formulas with both signs turned.
	const Matrix3d R = skew(-xi.head<3>()), P = skew(-xi.tail<3>());
	const Coefficients k = coefficients(xi.tail<3>().norm());

	const Matrix3d PR = P * R, RP = R * P, PP = P * P, PRP = PR * P;
	const Matrix3d Q = 0.5 * R + k.b * (PR + RP + PRP) + k.c * (P * PR + RP * P - 3 * PRP) +
					   k.d * (PRP * P + P * PRP);
	const Matrix3d inverse = Matrix3d::Identity() - 0.5 * P + k.inverse * PP;

	Matrix6 J;
	J.topLeftCorner<3, 3>() = inverse;
	J.topRightCorner<3, 3>() = -inverse * Q * inverse;
	J.bottomLeftCorner<3, 3>().setZero();
	J.bottomRightCorner<3, 3>() = inverse;
	return J;
}

Matrix6 adjoint(const RigidTransform& T)
{
	const Matrix3d R = T.rotation.toRotationMatrix();
	Matrix6 Ad;
	Ad.topLeftCorner<3, 3>() = R;
	Ad.topRightCorner<3, 3>() = skew(T.translation) * R;
	Ad.bottomLeftCorner<3, 3>().setZero();
	Ad.bottomRightCorner<3, 3>() = R;
	return Ad;
}

Vector6 poseResidual(
	const RigidTransform& Z_a_b, const RigidTransform& T_world_a, const RigidTransform& T_world_b,
	Matrix6* jacobianA, Matrix6* jacobianB)
{
	const RigidTransform T_a_b = T_world_a.inverse() * T_world_b;
	const Vector6 e = logarithm(Z_a_b.inverse() * T_a_b);
	if (!jacobianA && !jacobianB) return e;

	const Matrix6 J = inverseRightJacobian(e);
	if (jacobianA) jacobianA->noalias() = -J * adjoint(T_a_b.inverse());
	if (jacobianB) *jacobianB = J;
	return e;
}

}  // namespace semloop
