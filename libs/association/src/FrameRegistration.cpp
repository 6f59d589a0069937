#include <semloop/association/FrameRegistration.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "MotionSearch.h"

namespace semloop
{
namespace
{
using Eigen::Vector3d;

constexpr std::size_t kMostPairs = 40;

Vector3d toEigen(const mrpt::math::TPoint3D& p)
{
	return {p.x, p.y, p.z};
}

std::vector<RegistrationPair> candidatePairs(
	const std::vector<AssociationItem>& landmarks, const std::vector<AssociationItem>& detections,
	const PoseSigma& prior, const FrameRegistrationOptions& options)
{
	std::vector<RegistrationPair> pairs;
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
				pairs.push_back({j, k, from, to, 1 / (sigma * sigma), similarity});
		}
	const auto isBetter = [](const RegistrationPair& a, const RegistrationPair& b)
	{
		if (a.similarity != b.similarity) return a.similarity > b.similarity;
		return (a.to - a.from).squaredNorm() < (b.to - b.from).squaredNorm();
	};
	std::stable_sort(pairs.begin(), pairs.end(), isBetter);
	if (pairs.size() > kMostPairs) pairs.resize(kMostPairs);
	return pairs;
}

mrpt::poses::CPose3D poseOf(const CameraMotion& motion)
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
	const MotionSearch search(pairs, prior);

	const auto expected = search.evaluate(CameraMotion());
	auto found = expected;
	if (expected.cost - search.leastCost() >= MotionSearch::kLeastGain)
		found = search.best(expected);
	if (found.inliers.size() < std::size_t(options.minPairs)) return result;

	MotionSearch::Matrix6 information;
	const CameraMotion motion = search.fit(found.inliers, found.motion, &information);
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
