#pragma once

#include <semloop/association/FrameRegistration.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace semloop
{
/** A landmark and a detection that may be the same. */
struct RegistrationPair
{
	std::size_t landmark = 0, detection = 0;
	Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
	double weight = 0;  //!< inverse variance of the difference [1/m^2]
	double similarity = 0;
};

/** to = exp(rotation) from + translation */
struct CameraMotion
{
	Eigen::Vector3d rotation = Eigen::Vector3d::Zero(), translation = Eigen::Vector3d::Zero();

	Eigen::Matrix3d R() const;
};

/** The search of registerFrame: the motion of least cost, a truncated sum of squares over one-to-one
 *  pairs plus the prior. */
class MotionSearch
{
public:
	using Pairs = std::vector<const RegistrationPair*>;
	using Matrix6 = Eigen::Matrix<double, 6, 6>;

	/** What a motion has to explain beyond chance, for six degrees of freedom: 99.9 %. */
	static constexpr double kLeastGain = 22.5;

	struct Solution
	{
		CameraMotion motion;
		Pairs inliers;
		double cost = 0;
	};

	/** The pairs must outlive it. */
	MotionSearch(const std::vector<RegistrationPair>& pairs, const PoseSigma& prior);

	/** Least squares by Gauss-Newton, begun at `motion`; information: H of the last step. */
	CameraMotion fit(const Pairs& pairs, CameraMotion motion, Matrix6* information = nullptr) const;

	Solution evaluate(const CameraMotion& motion) const;

	/** The best motion that two pairs propose, fitted to its inliers; `expected` when none is better by
	 *  kLeastGain than that and than any other without a pair in common. */
	Solution best(const Solution& expected) const;

	/** No motion has a cost below this. */
	double leastCost() const;

private:
	const std::vector<RegistrationPair>& pairs_;
	double weightT_, weightR_;
};

}  // namespace semloop
