#include <semloop/loop_closure/CameraVerification.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/features2d.hpp>
#include <utility>
#include <vector>

namespace semloop
{
namespace
{
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kFloorTranslation = 0.01;  // [m]
constexpr double kFloorRotation = 0.0087;   // [rad]
// Standard deviation of depth, structured light: a + b z^2 [m].
constexpr double kDepthSigma = 0.005, kDepthSigmaOfSquare = 0.0015;

/** (query, target) */
using FeatureMatches = std::vector<std::pair<std::size_t, std::size_t>>;

FeatureMatches matchFeatures(
	const OrbFeatures& query, const OrbFeatures& target, const CameraVerificationOptions& options)
{
	FeatureMatches result;
	if (query.size() < 2 || target.size() < 2) return result;
	const cv::BFMatcher matcher(cv::NORM_HAMMING);
	std::vector<std::vector<cv::DMatch>> forward;
	std::vector<cv::DMatch> backward;
	matcher.knnMatch(query.descriptors, target.descriptors, forward, 2);
	matcher.match(target.descriptors, query.descriptors, backward);
	for (const auto& best : forward)
	{
		if (best.size() < 2 || best[0].distance > float(options.maxDistance)) continue;
		if (double(best[0].distance) > options.ratio * double(best[1].distance)) continue;
		if (backward[std::size_t(best[0].trainIdx)].trainIdx != best[0].queryIdx) continue;
		result.emplace_back(std::size_t(best[0].queryIdx), std::size_t(best[0].trainIdx));
	}
	return result;
}

struct Projection
{
	Eigen::Vector3d point;  //!< in the query's camera [m]
	Eigen::Vector2d error;  //!< [pixel]
};

Projection project(
	const OrbFeatures& query, std::size_t feature, const Eigen::Isometry3d& T_query_target,
	const Eigen::Vector3d& target)
{
	const Eigen::Vector3d p = T_query_target * target;
	const auto& camera = query.camera;
	const Eigen::Vector2d pixel(
		camera.fx() * p.x() / p.z() + camera.cx(), camera.fy() * p.y() / p.z() + camera.cy());
	return {p, pixel - query.pixels[feature].cast<double>()};
}

FeatureMatches inliersOf(
	const FeatureMatches& matches, const OrbFeatures& query, const OrbFeatures& target,
	const Eigen::Isometry3d& T_query_target, const CameraVerificationOptions& options)
{
	FeatureMatches inliers;
	for (const auto& match : matches)
	{
		const auto at = project(query, match.first, T_query_target, target.point(match.second));
		if (!(at.point.z() > 0) || at.error.norm() > options.maxReprojection) continue;
		const double depth = query.depths[match.first];
		// Both depths have their error.
		const double sigma =
			std::sqrt(2.0) * (kDepthSigma + kDepthSigmaOfSquare * at.point.z() * at.point.z());
		// At an edge the neighbouring pixel is as good.
		if (depth > 0 && std::abs(depth - at.point.z()) > 3 * sigma + 0.05) continue;
		inliers.push_back(match);
	}
	return inliers;
}

/** p' = p - t - w x p for a small motion of the query's camera. */
Matrix6d informationOf(
	const FeatureMatches& inliers, const OrbFeatures& query, const OrbFeatures& target,
	const Eigen::Isometry3d& T_query_target, double sigma)
{
	Matrix6d information = Matrix6d::Zero();
	for (const auto& [q, t] : inliers)
	{
		const Eigen::Vector3d p = T_query_target * target.point(t);
		Eigen::Matrix<double, 2, 3> byPoint;
		byPoint << query.camera.fx() / p.z(), 0, -query.camera.fx() * p.x() / (p.z() * p.z()), 0,
			query.camera.fy() / p.z(), -query.camera.fy() * p.y() / (p.z() * p.z());
		Eigen::Matrix<double, 3, 6> byMotion;
		byMotion.leftCols<3>() = -Eigen::Matrix3d::Identity();
		byMotion.rightCols<3>() << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
		const Eigen::Matrix<double, 2, 6> J = byPoint * byMotion;
		information += J.transpose() * J / (sigma * sigma);
	}
	return information;
}

/** With the floor on the covariance; empty when a direction is left open. */
std::optional<Matrix6d> withFloor(const Matrix6d& information)
{
	const Eigen::LDLT<Matrix6d> factor(information);
	if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 1e-6)) return {};
	Matrix6d covariance = factor.solve(Matrix6d::Identity());
	covariance.diagonal().head<3>().array() += kFloorTranslation * kFloorTranslation;
	covariance.diagonal().tail<3>().array() += kFloorRotation * kFloorRotation;
	const Matrix6d result = covariance.inverse();
	if (!result.allFinite()) return {};
	return 0.5 * (result + result.transpose());
}

mrpt::poses::CPose3D toPose(const Eigen::Isometry3d& T)
{
	return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(Eigen::Matrix4d(T.matrix())));
}
}  // namespace

void CameraVerificationOptions::describe(OptionFields& fields)
{
	fields.number(
		"ratio", ratio, 0.1, 1, "Hamming distance of the best match / of the second best");
	fields.integer("max_distance", maxDistance, 1, 256, "Hamming distance of a match [bits]");
	fields.number("pixel_sigma", pixelSigma, 0.01, 100, "of a feature's place [pixel]");
	fields.number("max_reprojection", maxReprojection, 0.1, 100, "of an inlier [pixel]");
	fields.integer("iterations", iterations, 1, 1000000, "of RANSAC");
	fields.integer("min_inliers", minInliers, 6, 100000, "features that agree with the pose");
}

CameraComparison compareCameras(
	const OrbFeatures& query, const OrbFeatures& target, const CameraVerificationOptions& options)
{
	CameraComparison result;
	FeatureMatches matches;
	std::vector<cv::Point3d> points;
	std::vector<cv::Point2d> pixels;
	for (const auto& match : matchFeatures(query, target, options))
	{
		if (target.depths[match.second] <= 0) continue;
		matches.push_back(match);
		const Eigen::Vector3d p = target.point(match.second);
		points.emplace_back(p.x(), p.y(), p.z());
		const auto& pixel = query.pixels[match.first];
		pixels.emplace_back(double(pixel.x()), double(pixel.y()));
	}
	result.matches = matches.size();
	if (int(matches.size()) < options.minInliers) return result;

	const cv::Matx33d K(
		query.camera.fx(), 0, query.camera.cx(), 0, query.camera.fy(), query.camera.cy(), 0, 0, 1);
	cv::Vec3d rotation, translation;
	std::vector<int> sampled;
	if (!cv::solvePnPRansac(
			points, pixels, K, cv::noArray(), rotation, translation, false, options.iterations,
			float(options.maxReprojection), 0.999, sampled, cv::SOLVEPNP_EPNP) ||
		int(sampled.size()) < options.minInliers)
		return result;
	std::vector<cv::Point3d> inlierPoints;
	std::vector<cv::Point2d> inlierPixels;
	for (const int i : sampled)
	{
		inlierPoints.push_back(points[std::size_t(i)]);
		inlierPixels.push_back(pixels[std::size_t(i)]);
	}
	cv::solvePnPRefineLM(inlierPoints, inlierPixels, K, cv::noArray(), rotation, translation);

	cv::Matx33d R;
	cv::Rodrigues(rotation, R);
	Eigen::Isometry3d T_query_target = Eigen::Isometry3d::Identity();
	Eigen::Matrix3d linear;
	cv::cv2eigen(R, linear);
	T_query_target.linear() = linear;
	T_query_target.translation() << translation[0], translation[1], translation[2];
	if (!T_query_target.matrix().allFinite()) return result;
	const auto inliers = inliersOf(matches, query, target, T_query_target, options);
	if (int(inliers.size()) < options.minInliers) return result;
	const auto information =
		withFloor(informationOf(inliers, query, target, T_query_target, options.pixelSigma));
	if (!information) return result;
	result.pose = CameraPose{toPose(T_query_target.inverse()), *information, inliers.size()};
	return result;
}

}  // namespace semloop
