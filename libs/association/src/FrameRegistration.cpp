#include <semloop/association/FrameRegistration.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace semloop
{
namespace
{
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Residuals beyond count as this: 99 % of three degrees of freedom.
constexpr double kTruncation = 11.3;
// What a motion has to explain beyond chance, for six degrees of freedom: 99.9 %.
constexpr double kLeastGain = 22.5;
constexpr std::size_t kMostPairs = 40;
// A prior is never more certain than this.
constexpr double kLeastSigmaTranslation = 1e-3, kLeastSigmaRotation = 1e-3;

Vector3d toEigen(const mrpt::math::TPoint3D& p)
{
	return {p.x, p.y, p.z};
}

double square(double v)
{
	return v * v;
}

struct Pair
{
	std::size_t landmark = 0, detection = 0;
	Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();
	double weight = 0;  //!< inverse variance of the difference [1/m^2]
	double similarity = 0;
};
using Pairs = std::vector<const Pair*>;

struct Motion
{
	Vector3d rotation = Vector3d::Zero(), translation = Vector3d::Zero();

	Eigen::Matrix3d R() const
	{
		const double angle = rotation.norm();
		if (angle == 0) return Eigen::Matrix3d::Identity();
		return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
	}
};

std::vector<Pair> candidatePairs(
	const std::vector<AssociationItem>& landmarks, const std::vector<AssociationItem>& detections,
	const PoseSigma& prior, const FrameRegistrationOptions& options)
{
	std::vector<Pair> pairs;
	for (std::size_t j = 0; j < landmarks.size(); ++j)
		for (std::size_t k = 0; k < detections.size(); ++k)
		{
			const AssociationItem &landmark = landmarks[j], &detection = detections[k];
			if (!landmark.surface || !detection.surface) continue;
			double similarity = 0.5;
			bool alike =
				!landmark.labelScores->empty() && !detection.labelScores->empty() &&
				landmark.labelScores->front().label == detection.labelScores->front().label;
			if (landmark.embeddings && detection.embeddings)
				if (const auto s = embeddingSimilarity(*landmark.embeddings, *detection.embeddings))
				{
					similarity = *s;
					alike = similarity >= options.minSimilarity;
				}
			if (!alike) continue;
			const SurfaceExtent &a = *landmark.surface, &b = *detection.surface;
			const Vector3d from = toEigen(a.centre), to = toEigen(b.centre);
			// What moves the centre is that other parts are seen.
			const double sigma = std::hypot(
				options.sigmaCentre, options.sigmaPerRadius * std::max(a.radius, b.radius),
				a.radius - b.radius);
			const double reach = 4 * (prior.translation + prior.rotation * from.norm() + sigma);
			if ((to - from).norm() < reach)
				pairs.push_back({j, k, from, to, 1 / square(sigma), similarity});
		}
	const auto isBetter = [](const Pair& a, const Pair& b)
	{
		if (a.similarity != b.similarity) return a.similarity > b.similarity;
		return (a.to - a.from).squaredNorm() < (b.to - b.from).squaredNorm();
	};
	std::stable_sort(pairs.begin(), pairs.end(), isBetter);
	if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
	return pairs;
}

struct Solution
{
	Motion motion;
	Pairs inliers;
	double cost = 0;
};

bool areDisjoint(const Pairs& a, const Pairs& b)
{
	const auto isInB = [&](const Pair* pair) { return std::count(b.begin(), b.end(), pair) > 0; };
	return std::none_of(a.begin(), a.end(), isInB);
}

class Registration
{
public:
	Registration(const std::vector<Pair>& pairs, const PoseSigma& prior)
		: pairs_(pairs),
		  weightT_(1 / square(std::max(prior.translation, kLeastSigmaTranslation))),
		  weightR_(1 / square(std::max(prior.rotation, kLeastSigmaRotation)))
	{
	}

	/** Gauss-Newton; H of the last step. */
	Motion fit(const Pairs& pairs, Motion motion, Matrix6* information = nullptr) const
	{
		Matrix6 H;
		for (int iteration = 0; iteration < 3; ++iteration)
		{
			const Eigen::Matrix3d R = motion.R();
			H.setZero();
			H.diagonal() << Vector3d::Constant(weightT_), Vector3d::Constant(weightR_);
			Vector6 g;
			g << -weightT_ * motion.translation, -weightR_ * motion.rotation;
			for (const Pair* pair : pairs)
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
			const Motion turn{step.tail<3>(), Vector3d::Zero()};
			const Eigen::AngleAxisd turned(Eigen::Matrix3d(turn.R() * R));
			motion.rotation = turned.angle() * turned.axis();
		}
		if (information) *information = H;
		return motion;
	}

	/** The cost is a truncated sum over one-to-one pairs, the prior included; less is better. */
	Solution evaluate(const Motion& motion) const
	{
		struct Residual
		{
			double chi2;
			const Pair* pair;
		};
		const Eigen::Matrix3d R = motion.R();
		std::vector<Residual> residuals;
		for (const Pair& pair : pairs_)
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
			const auto isTaken = [p = pair](const Pair* o)
			{ return o->landmark == p->landmark || o->detection == p->detection; };
			if (std::any_of(result.inliers.begin(), result.inliers.end(), isTaken)) continue;
			result.inliers.push_back(pair);
			result.cost += chi2 - kTruncation;
		}
		return result;
	}

	/** The best motion that two pairs propose, fitted to its inliers; `expected` when none is better by
	 *  kLeastGain than that and than any other without a pair in common. */
	Solution search(const Solution& expected) const
	{
		std::vector<Solution> proposed;
		for (const Pair& a : pairs_)
			for (const Pair* b = pairs_.data(); b != &a; ++b)
				if (a.landmark != b->landmark && a.detection != b->detection)
					proposed.push_back(evaluate(fit({&a, b}, Motion())));
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

private:
	const std::vector<Pair>& pairs_;
	double weightT_, weightR_;
};

/** No motion has a cost below this. */
double leastCost(const std::vector<Pair>& pairs)
{
	std::set<std::size_t> landmarks, detections;
	for (const Pair& pair : pairs)
	{
		landmarks.insert(pair.landmark);
		detections.insert(pair.detection);
	}
	return -kTruncation * double(std::min(landmarks.size(), detections.size()));
}

mrpt::poses::CPose3D poseOf(const Motion& motion)
{
	mrpt::math::CMatrixDouble33 R;
	R.asEigen() = motion.R();
	const Vector3d& t = motion.translation;
	return mrpt::poses::CPose3D(R, mrpt::math::TVector3D(t.x(), t.y(), t.z()));
}
}  // namespace

PoseSigma operator+(const PoseSigma& a, const PoseSigma& b)
{
	return {std::hypot(a.translation, b.translation), std::hypot(a.rotation, b.rotation)};
}

PoseSigma sigmaOf(const Eigen::Matrix<double, 6, 6>& covariance)
{
	return {
		std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3),
		std::sqrt(covariance.bottomRightCorner<3, 3>().trace() / 3)};
}

void FrameRegistrationOptions::describe(OptionFields& f)
{
	f.flag(
		"enabled", enabled,
		"corrects the camera by what all detections agree on; not in the paper");
	f.number("sigma_centre", sigmaCentre, 1e-3, 10, "of a small object's centre [m]");
	f.number(
		"sigma_per_radius", sigmaPerRadius, 0, 10,
		"of a large object's centre, in radii of what is visible of it");
	f.number("min_similarity", minSimilarity, -1, 1, "of the embeddings of a pair");
	f.integer("min_pairs", minPairs, 2, 100, "that have to agree");
}

FrameRegistration registerFrame(
	const std::vector<AssociationItem>& landmarks, const std::vector<AssociationItem>& detections,
	const PoseSigma& prior, const FrameRegistrationOptions& options)
{
	FrameRegistration result;
	result.sigma = prior;
	if (!options.enabled) return result;
	const auto pairs = candidatePairs(landmarks, detections, prior, options);
	if (pairs.size() < std::size_t(options.minPairs)) return result;
	const Registration registration(pairs, prior);

	const Solution expected = registration.evaluate(Motion());
	Solution found = expected;
	if (expected.cost - leastCost(pairs) >= kLeastGain) found = registration.search(expected);
	if (found.inliers.size() < std::size_t(options.minPairs)) return result;

	Matrix6 information;
	const Motion motion = registration.fit(found.inliers, found.motion, &information);
	result.sigma = sigmaOf(information.inverse());
	result.pairs = int(found.inliers.size());
	if (found.cost < expected.cost)
		result.T_seen_expected = poseOf(motion);
	else  // What the pairs would have moved may yet be an error.
		result.sigma = result.sigma + PoseSigma{
										  motion.translation.norm() / std::sqrt(3.0),
										  motion.rotation.norm() / std::sqrt(3.0)};
	return result;
}

}  // namespace semloop
