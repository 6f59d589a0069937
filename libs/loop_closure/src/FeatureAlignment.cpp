#include <pcl/features/fpfh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <random>

#include "SurfaceClouds.h"

namespace semloop
{
namespace
{
constexpr std::size_t kLeastInliers = 10;
constexpr double kLeastSide = 0.08;  // of a sampled triangle [m]

using Features = Eigen::Matrix<float, 33, Eigen::Dynamic>;

Features computeFeatures(const Cloud& cloud, double radius)
{
	auto points = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
	auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
	for (Eigen::Index i = 0; i < cloud.size(); ++i)
	{
		const Eigen::Vector3f p = cloud.points.col(i).cast<float>();
		const Eigen::Vector3f n = cloud.normals.col(i).cast<float>();
		points->emplace_back(p.x(), p.y(), p.z());
		normals->emplace_back(n.x(), n.y(), n.z());
	}
	pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
	estimation.setInputCloud(points);
	estimation.setInputNormals(normals);
	estimation.setRadiusSearch(radius);
	pcl::PointCloud<pcl::FPFHSignature33> signatures;
	estimation.compute(signatures);

	Features features(33, cloud.size());
	for (Eigen::Index i = 0; i < cloud.size(); ++i)
		features.col(i) = Eigen::Map<const Eigen::Matrix<float, 33, 1>>(signatures[i].histogram);
	return features;
}

struct FeatureMatch
{
	Eigen::Vector3d query, target, queryNormal, targetNormal;
};

/** The most similar target point of each query point that has a describable neighbourhood. */
void matchFeatures(
	const CloudPair& pair, const ObjectAlignerOptions& options, std::vector<FeatureMatch>& matches)
{
	const Cloud target = thinned(pair.target, options.queryVoxel);
	const Features queryFeatures = computeFeatures(pair.query, options.featureRadius);
	const Features targetFeatures = computeFeatures(target, options.featureRadius);
	for (Eigen::Index i = 0; i < pair.query.size(); ++i)
	{
		if (!queryFeatures.col(i).allFinite()) continue;
		Eigen::Index best = -1;
		float least = std::numeric_limits<float>::infinity();
		for (Eigen::Index k = 0; k < target.size(); ++k)
		{
			const float difference = (targetFeatures.col(k) - queryFeatures.col(i)).squaredNorm();
			if (difference < least) least = difference, best = k;
		}
		if (best >= 0)
			matches.push_back(
				{pair.query.points.col(i), target.points.col(best), pair.query.normals.col(i),
				 target.normals.col(best)});
	}
}

Eigen::Isometry3d fitRigid(const std::vector<const FeatureMatch*>& matches)
{
	Eigen::Matrix3Xd query(3, matches.size()), target(3, matches.size());
	for (std::size_t i = 0; i < matches.size(); ++i)
	{
		query.col(static_cast<Eigen::Index>(i)) = matches[i]->query;
		target.col(static_cast<Eigen::Index>(i)) = matches[i]->target;
	}
	return Eigen::Isometry3d(Eigen::umeyama(query, target, false));
}

/** Three matches whose triangles are alike and not degenerate. */
bool isPlausible(const std::array<const FeatureMatch*, 3>& sample, double tolerance)
{
	for (int i = 0; i < 3; ++i)
	{
		const auto *a = sample[i], *b = sample[(i + 1) % 3];
		const double query = (a->query - b->query).norm(), target = (a->target - b->target).norm();
		if (query < kLeastSide || std::abs(query - target) > tolerance) return false;
	}
	return true;
}

std::vector<const FeatureMatch*> inliersOf(
	const Eigen::Isometry3d& T, const std::vector<FeatureMatch>& matches,
	const ObjectAlignerOptions& options)
{
	const double limit = mrpt::square(options.ransacDistance);
	const double leastCosine = std::cos(options.maxNormalAngle);
	std::vector<const FeatureMatch*> inliers;
	for (const auto& match : matches)
		if ((T * match.query - match.target).squaredNorm() <= limit &&
			match.targetNormal.dot(T.linear() * match.queryNormal) >= leastCosine)
			inliers.push_back(&match);
	return inliers;
}
}  // namespace

std::optional<Eigen::Isometry3d> alignFeatures(
	const CloudPairs& pairs, const ObjectAlignerOptions& options)
{
	std::vector<FeatureMatch> matches;
	for (const auto& pair : pairs) matchFeatures(pair, options, matches);
	if (matches.size() < kLeastInliers) return {};

	std::mt19937 random(static_cast<unsigned>(options.seed));
	std::uniform_int_distribution<std::size_t> any(0, matches.size() - 1);
	std::vector<const FeatureMatch*> best;
	for (int i = 0; i < options.ransacIterations; ++i)
	{
		std::array<const FeatureMatch*, 3> sample{};
		for (auto& match : sample) match = &matches[any(random)];
		if (!isPlausible(sample, options.ransacDistance)) continue;
		const auto T = fitRigid({sample.begin(), sample.end()});
		auto inliers = inliersOf(T, matches, options);
		if (inliers.size() > best.size()) best = std::move(inliers);
	}
	if (best.size() < kLeastInliers) return {};
	return fitRigid(best);
}

}  // namespace semloop
