#include <semloop/pose_graph/PoseResidual.h>
#include <semloop/slam/DriftPrior.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace semloop
{
namespace
{
// What a loop closure itself may err by: centres of half-seen objects are not more exact.
constexpr double kLoopSigma = 0.3;        // [m]
constexpr double kLoopSigmaAngle = 0.15;  // [rad]

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v)
{
	Eigen::Matrix3d m;
	m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
	return m;
}
}  // namespace

void DriftPrior::add(const OdometryEstimate& odometry)
{
	if (steps_.empty())
	{
		steps_.emplace_back();
		return;
	}
	const Step& last = steps_.back();
	const Matrix6 Ad = adjoint(RigidTransform::fromPose(odometry.T_previous_camera).inverse());
	steps_.push_back(
		{last.T_first_camera + odometry.T_previous_camera,
		 Ad * last.covariance * Ad.transpose() + odometry.covariance});
}

Matrix6 DriftPrior::covariance(std::size_t a, std::size_t b) const
{
	const Step &from = steps_.at(a), &to = steps_.at(b);
	const Matrix6 Ad =
		adjoint(RigidTransform::fromPose(to.T_first_camera - from.T_first_camera).inverse());
	const Matrix6 P = to.covariance - Ad * from.covariance * Ad.transpose();
	return 0.5 * (P + P.transpose());
}

Eigen::Matrix4d DriftPrior::covarianceAt(
	std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
	const mrpt::math::TPoint3D& point) const
{
	const Eigen::Matrix3d R = T_world_camera.getRotationMatrix().asEigen();
	const auto local = T_world_camera.inverseComposePoint(point);
	Eigen::Matrix<double, 4, 6> J;
	J.topLeftCorner<3, 3>() = R;
	J.topRightCorner<3, 3>() = -R * crossMatrix({local.x, local.y, local.z});
	J.bottomLeftCorner<1, 3>().setZero();
	J.bottomRightCorner<1, 3>() = R.row(2);

	Eigen::Matrix4d S = J * covariance(a, b) * J.transpose();
	S.diagonal() += Eigen::Vector4d(
		kLoopSigma * kLoopSigma, kLoopSigma * kLoopSigma, kLoopSigma * kLoopSigma,
		kLoopSigmaAngle * kLoopSigmaAngle);
	return S;
}

double DriftPrior::sigmas(
	std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
	const mrpt::poses::CPose3D& T_target_query, const mrpt::math::TPoint3D& point) const
{
	const Eigen::Matrix4d S = covarianceAt(a, b, T_world_camera, point);
	const auto moved = T_target_query.composePoint(point) - point;
	const Eigen::Vector4d e(moved.x, moved.y, moved.z, T_target_query.yaw());
	return std::sqrt(e.dot(S.llt().solve(e)));
}

PosePrior DriftPrior::prior(
	std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
	const mrpt::math::TPoint3D& point) const
{
	const Eigen::Matrix4d S = covarianceAt(a, b, T_world_camera, point);
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> horizontal(
		S.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
	return {{}, std::sqrt(horizontal.eigenvalues()(1)), std::sqrt(S(2, 2)), std::sqrt(S(3, 3))};
}

}  // namespace semloop
