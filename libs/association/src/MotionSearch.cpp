#include "MotionSearch.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <utility>

namespace semloop
{
namespace
{
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Residuals beyond count as this: 99 % of three degrees of freedom.
constexpr double kTruncation = 11.3;
// A prior is never more certain than this.
constexpr double kLeastSigmaTranslation = 1e-3, kLeastSigmaRotation = 1e-3;

double inverseVariance(double sigma)
{
	return 1 / (sigma * sigma);
}

bool areDisjoint(const MotionSearch::Pairs& a, const MotionSearch::Pairs& b)
{
	const auto isInB = [&](const RegistrationPair* pair)
	{ return std::count(b.begin(), b.end(), pair) > 0; };
	return std::none_of(a.begin(), a.end(), isInB);
}

}  // namespace

Eigen::Matrix3d CameraMotion::R() const
{
	const double angle = rotation.norm();
	if (angle == 0) return Eigen::Matrix3d::Identity();
	return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

MotionSearch::MotionSearch(const std::vector<RegistrationPair>& pairs, const PoseSigma& prior)
	: pairs_(pairs),
	  weightT_(inverseVariance(std::max(prior.translation, kLeastSigmaTranslation))),
	  weightR_(inverseVariance(std::max(prior.rotation, kLeastSigmaRotation)))
{
}

CameraMotion MotionSearch::fit(const Pairs& pairs, CameraMotion motion, Matrix6* information) const
{
	Matrix6 H;
	for (int iteration = 0; iteration < 3; ++iteration)
	{
		const Eigen::Matrix3d R = motion.R();
		H.setZero();
		H.diagonal() << Vector3d::Constant(weightT_), Vector3d::Constant(weightR_);
		Vector6 g;
		g << -weightT_ * motion.translation, -weightR_ * motion.rotation;
		for (const RegistrationPair* pair : pairs)
		{
			// exp(w) R p is R p + w x R p.
			const Vector3d p = R * pair->from;
			Eigen::Matrix<double, 3, 6> J;
			J << 1, 0, 0, 0, p.z(), -p.y(),  //
				0, 1, 0, -p.z(), 0, p.x(),   //
				0, 0, 1, p.y(), -p.x(), 0;
			H += pair->weight * J.transpose() * J;
			g += pair->weight * J.transpose() * (pair->to - p - motion.translation);
		}
		const Vector6 step = H.ldlt().solve(g);
		motion.translation += step.head<3>();
		const CameraMotion turn{step.tail<3>(), Vector3d::Zero()};
		const Eigen::AngleAxisd turned(Eigen::Matrix3d(turn.R() * R));
		motion.rotation = turned.angle() * turned.axis();
	}
	if (information) *information = H;
	return motion;
}

MotionSearch::Solution MotionSearch::evaluate(const CameraMotion& motion) const
{
	struct Residual
	{
		double chi2;
		const RegistrationPair* pair;
	};
	const Eigen::Matrix3d R = motion.R();
	std::vector<Residual> residuals;
	for (const RegistrationPair& pair : pairs_)
	{
		const double chi2 =
			pair.weight * (pair.to - R * pair.from - motion.translation).squaredNorm();
		if (chi2 < kTruncation) residuals.push_back({chi2, &pair});
	}
	std::stable_sort(
		residuals.begin(), residuals.end(),
		[](const Residual& a, const Residual& b) { return a.chi2 < b.chi2; });
	Solution result;
	result.motion = motion;
	result.cost =
		weightT_ * motion.translation.squaredNorm() + weightR_ * motion.rotation.squaredNorm();
	for (const auto& [chi2, pair] : residuals)
	{
		const auto isTaken = [p = pair](const RegistrationPair* o)
		{ return o->landmark == p->landmark || o->detection == p->detection; };
		if (std::any_of(result.inliers.begin(), result.inliers.end(), isTaken)) continue;
		result.inliers.push_back(pair);
		result.cost += chi2 - kTruncation;
	}
	return result;
}

MotionSearch::Solution MotionSearch::best(const Solution& expected) const
{
	std::vector<Solution> proposed;
	for (const RegistrationPair& a : pairs_)
		for (const RegistrationPair* b = pairs_.data(); b != &a; ++b)
			if (a.landmark != b->landmark && a.detection != b->detection)
				proposed.push_back(evaluate(fit({&a, b}, CameraMotion())));
	const auto isBetter = [](const Solution& a, const Solution& b) { return a.cost < b.cost; };
	const auto first = std::min_element(proposed.begin(), proposed.end(), isBetter);
	if (first == proposed.end()) return expected;
	Solution best = *first;
	for (int i = 0; i < 3; ++i)
	{
		auto refined = evaluate(fit(best.inliers, best.motion));
		if (refined.cost < best.cost) best = std::move(refined);
	}
	if (best.cost > expected.cost - kLeastGain) return expected;
	for (const Solution& rival : proposed)
		if (rival.cost < best.cost + kLeastGain && areDisjoint(rival.inliers, best.inliers))
			return expected;
	return best;
}

double MotionSearch::leastCost() const
{
	std::set<std::size_t> landmarks, detections;
	for (const RegistrationPair& pair : pairs_)
	{
		landmarks.insert(pair.landmark);
		detections.insert(pair.detection);
	}
	return -kTruncation * double(std::min(landmarks.size(), detections.size()));
}

}  // namespace semloop
