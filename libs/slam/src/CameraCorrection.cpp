#include <mrpt/poses/Lie/SO.h>
#include <semloop/slam/CameraCorrection.h>

#include <algorithm>
#include <cmath>

using mrpt::poses::CPose3D;

namespace semloop
{
namespace
{
constexpr double kLeastSigma = 1e-6;  // keeps the weights finite [m, rad]

double inverseVariance(double sigma)
{
	return 1 / std::pow(std::max(sigma, kLeastSigma), 2);
}

PoseSigma sigmaOf(const Eigen::Matrix<double, 6, 6>& covariance)
{
	return {
		std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3),
		std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3)};
}

/** The pose that many parts of the way from the identity. */
CPose3D partOf(const CPose3D& pose, double translation, double rotation)
{
	using SO3 = mrpt::poses::Lie::SO<3>;
	const auto angle = SO3::log(pose.getRotationMatrix());
	return CPose3D(
		SO3::exp(mrpt::math::CVectorFixedDouble<3>(angle * rotation)),
		mrpt::math::TVector3D(
			pose.x() * translation, pose.y() * translation, pose.z() * translation));
}
}  // namespace

void CameraCorrection::step(const OdometryEstimate& odometry)
{
	const CPose3D& T_previous_camera = odometry.T_previous_camera;
	T_odometry_camera_ = (-T_previous_camera) + T_odometry_camera_ + T_previous_camera;
	T_previous_camera_ = T_previous_camera_ + T_previous_camera;
	stepSigma_ = stepSigma_ + sigmaOf(odometry.covariance);
}

void CameraCorrection::track(const FrameRegistration& tracked)
{
	const CPose3D T_odometry_moved = T_odometry_camera_ + (-tracked.T_seen_expected);
	const PoseSigma moved = sigma_ + tracked.sigma;
	const double ofOnePose = std::sqrt(0.5);
	const PoseSigma odometry{ofOnePose * stepSigma_.translation, ofOnePose * stepSigma_.rotation};

	const double translation = inverseVariance(moved.translation);
	const double rotation = inverseVariance(moved.rotation);
	const double bothTranslation = translation + inverseVariance(odometry.translation);
	const double bothRotation = rotation + inverseVariance(odometry.rotation);
	T_odometry_camera_ =
		partOf(T_odometry_moved, translation / bothTranslation, rotation / bothRotation);
	sigma_ = {1 / std::sqrt(bothTranslation), 1 / std::sqrt(bothRotation)};
	T_previous_camera_ = CPose3D();
	stepSigma_ = {};
}

void CameraCorrection::localize(const FrameRegistration& mapped)
{
	T_odometry_camera_ = T_odometry_camera_ + (-mapped.T_seen_expected);
	sigma_ = mapped.sigma;
}

}  // namespace semloop
