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

/** From a to b, by the inverse variances; sigma is what the mean has. */
struct WeightedMean
{
	CPose3D pose;
	PoseSigma sigma;
};

WeightedMean weightedMean(
	const CPose3D& a, const PoseSigma& sigmaA, const CPose3D& b, const PoseSigma& sigmaB)
{
	using SO3 = mrpt::poses::Lie::SO<3>;
	const double translation = inverseVariance(sigmaB.translation);
	const double rotation = inverseVariance(sigmaB.rotation);
	const double allTranslation = translation + inverseVariance(sigmaA.translation);
	const double allRotation = rotation + inverseVariance(sigmaA.rotation);

	const CPose3D T_a_b = (-a) + b;
	const double shareT = translation / allTranslation;
	const auto turn = SO3::log(T_a_b.getRotationMatrix());
	const CPose3D part(
		SO3::exp(mrpt::math::CVectorFixedDouble<3>(turn * (rotation / allRotation))),
		mrpt::math::TVector3D(T_a_b.x() * shareT, T_a_b.y() * shareT, T_a_b.z() * shareT));
	return {a + part, {1 / std::sqrt(allTranslation), 1 / std::sqrt(allRotation)}};
}
}  // namespace

void CameraCorrection::step(const OdometryEstimate& odometry)
{
	const CPose3D& T_previous_camera = odometry.T_previous_camera;
	T_odometry_camera_ = (-T_previous_camera) + T_odometry_camera_ + T_previous_camera;
	T_odometry_biased_ = (-T_previous_camera) + T_odometry_biased_ + T_previous_camera;
	T_previous_camera_ = T_previous_camera_ + T_previous_camera;

	const PoseSigma sigma = sigmaOf(odometry.covariance);
	stepSigma_ = stepSigma_ + sigma;
	poseSigma_ = {std::sqrt(0.5) * sigma.translation, std::sqrt(0.5) * sigma.rotation};
	const bool isLost = odometry.status == OdometryEstimate::Status::Lost;
	// The step behind a loss may mend it or not.
	if (isLost || wasLost_) biasSigma_ = biasSigma_ + sigma;
	wasLost_ = isLost;
}

void CameraCorrection::track(const FrameRegistration& tracked)
{
	const auto mean = weightedMean(
		T_odometry_biased_, poseSigma_ + biasSigma_,
		T_odometry_camera_ + (-tracked.T_seen_expected), sigma_ + tracked.sigma);
	T_odometry_camera_ = mean.pose;
	sigma_ = mean.sigma;
	T_previous_camera_ = CPose3D();
	stepSigma_ = {};
}

void CameraCorrection::localize(const FrameRegistration& mapped)
{
	T_odometry_camera_ = T_odometry_camera_ + (-mapped.T_seen_expected);
	sigma_ = mapped.sigma;
	if (mapped.pairs == 0) return;
	const auto bias =
		weightedMean(T_odometry_biased_, biasSigma_, T_odometry_camera_, sigma_ + poseSigma_);
	T_odometry_biased_ = bias.pose;
	biasSigma_ = bias.sigma;
}

}  // namespace semloop
