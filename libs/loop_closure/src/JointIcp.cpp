#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "SurfaceClouds.h"

namespace semloop
{
namespace
{
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kShrink = 0.85;     // of the search distance, an iteration
constexpr double kDamping = 1e-3;    // leaves alone what neither surfaces nor centres decide
constexpr double kConverged = 1e-5;  // [m], [rad]
constexpr double kEnough = 30;       // a handful of points is no surface
constexpr double kSymmetric = 1 / 16.0;
// Calibrated by alignment_benchmark: errors / what the cost's Hessian says, as a median.
constexpr double kJointSigma = 0.1;

/** H x = -g for a small motion x = (rotation, translation), applied on the target's side. */
struct NormalEquations
{
	Matrix6d H = Matrix6d::Identity() * kDamping;
	Vector6d g = Vector6d::Zero();

	void add(const Vector6d& jacobian, double residual, double weight)
	{
		H.noalias() += weight * jacobian * jacobian.transpose();
		g.noalias() += weight * residual * jacobian;
	}
};

Vector6d alongDirection(const Eigen::Vector3d& point, const Eigen::Vector3d& direction)
{
	Vector6d jacobian;
	jacobian << point.cross(direction), direction;
	return jacobian;
}

/** Of a residual along the target's normal, for the motion d of T C exp(d), C at this point of the query. */
Vector6d aboutPoint(
	const CloudPair& pair, const Correspondences::Item& item, const Eigen::Isometry3d& T,
	const Eigen::Vector3d& centre)
{
	const Eigen::Vector3d normal = T.linear().transpose() * pair.target.normals.col(item.target);
	Vector6d jacobian;
	jacobian << normal, (pair.query.points.col(item.query) - centre).cross(normal);
	return jacobian;
}

double tukey(double residual, double limit)
{
	const double ratio = residual / limit;
	return std::abs(ratio) < 1 ? mrpt::square(1 - ratio * ratio) : 0.0;
}

void addSurfaces(
	NormalEquations& equations, const Correspondences& found, double limit, double sigma)
{
	const double scale = 1 / (sigma * sigma * std::max<double>(1, double(found.items.size())));
	for (const auto& item : found.items)
	{
		const Eigen::Vector3d normal = item.pair->target.normals.col(item.target);
		equations.add(
			alongDirection(item.point, normal), item.residual, scale * tukey(item.residual, limit));
	}
}

void addCentres(
	NormalEquations& equations, const CloudPairs& pairs, const Eigen::Isometry3d& T, double sigma)
{
	for (const auto& pair : pairs)
	{
		const double scale = 1 / ((sigma * sigma + pair.centreVariance) * pairs.count());
		const Eigen::Vector3d centre = T * pair.queryCentre;
		for (int axis = 0; axis < 3; ++axis)
			equations.add(
				alongDirection(centre, Eigen::Vector3d::Unit(axis)),
				centre[axis] - pair.targetCentre[axis], scale);
	}
}

void addRotation(NormalEquations& equations, const Eigen::Isometry3d& T, const RotationPrior& prior)
{
	const Eigen::AngleAxisd error(T.linear() * prior.expected.transpose());
	for (int axis = 0; axis < 3; ++axis)
		equations.add(
			Vector6d::Unit(axis), error.angle() * error.axis()[axis],
			1 / mrpt::square(prior.sigma[axis]));
}

Eigen::Isometry3d motion(const Vector6d& x)
{
	const Eigen::Vector3d rotation = x.head<3>();
	const double angle = rotation.norm();
	Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
	if (angle > 1e-12) result.linear() = Eigen::AngleAxisd(angle, rotation / angle).matrix();
	result.translation() = x.tail<3>();
	return result;
}
}  // namespace

double Correspondences::rmse() const
{
	if (items.empty()) return 0;
	double sum = 0;
	for (const auto& item : items) sum += item.residual * item.residual;
	return std::sqrt(sum / static_cast<double>(items.size()));
}

Correspondences findCorrespondences(
	const CloudPairs& pairs, const Eigen::Isometry3d& T, double maxDistance, double maxNormalAngle)
{
	const double leastCosine = std::cos(maxNormalAngle);
	Correspondences result;
	for (const auto& pair : pairs)
		for (Eigen::Index i = 0; i < pair.query.size(); ++i)
		{
			const Eigen::Vector3d point = T * pair.query.points.col(i);
			const auto nearest = pair.nearestTarget.find(point, maxDistance);
			if (!nearest) continue;
			const Eigen::Vector3d normal = pair.target.normals.col(*nearest);
			if (normal.dot(T.linear() * pair.query.normals.col(i)) < leastCosine) continue;
			const double residual = normal.dot(point - pair.target.points.col(*nearest));
			result.items.push_back({&pair, i, *nearest, point, residual});
		}
	return result;
}

Refinement refine(
	const CloudPairs& pairs, const Eigen::Isometry3d& start, const RotationPrior& prior,
	const ObjectAlignerOptions& options)
{
	Refinement result;
	result.T = start;
	double distance = std::max(options.startDistance, options.endDistance);
	while (result.iterations < options.maxIterations)
	{
		++result.iterations;
		const auto found = findCorrespondences(pairs, result.T, distance, options.maxNormalAngle);
		NormalEquations equations;
		addSurfaces(equations, found, distance, options.surfaceSigma);
		addCentres(equations, pairs, result.T, options.centreSigma);
		addRotation(equations, result.T, prior);
		const Vector6d step = -equations.H.ldlt().solve(equations.g);
		result.T = motion(step) * result.T;
		result.T.linear() = Eigen::Quaterniond(result.T.linear()).normalized().matrix();

		const bool last = distance <= options.endDistance;
		if (last && step.norm() < kConverged) break;
		distance = std::max(options.endDistance, kShrink * distance);
	}
	return result;
}

RotationSeen rotationSeen(
	const CloudPair& pair, const Eigen::Isometry3d& T, const ObjectAlignerOptions& options)
{
	const auto found =
		findCorrespondences({&pair, &pair + 1}, T, options.endDistance, options.maxNormalAngle);
	if (double(found.items.size()) < kEnough) return RotationSeen::None;
	const auto count = double(found.items.size());
	// The vertical axis to which the normals point best, by least squares; of a surface that is seen in part it is
	// not through the centre.
	const Eigen::Vector2d centre = (T * pair.queryCentre).head<2>();
	Eigen::Matrix2d A = Eigen::Matrix2d::Identity() * kDamping * count;
	Eigen::Vector2d b = Eigen::Vector2d::Zero();
	double radius = 0;
	const auto forEach = [&](auto&& use)
	{
		for (const auto& item : found.items)
			use(item.point.head<2>() - centre, pair.target.normals.col(item.target).head<2>());
	};
	forEach(
		[&](const Eigen::Vector2d& p, const Eigen::Vector2d& n)
		{
			const Eigen::Vector2d across(n.y(), -n.x());
			A += across * across.transpose();
			b += across * across.dot(p);
			radius += p.squaredNorm() / count;
		});
	const Eigen::Vector2d axis = A.ldlt().solve(b);
	if (axis.squaredNorm() > radius) return RotationSeen::All;
	double turned = 0, all = 0;
	forEach(
		[&](const Eigen::Vector2d& p, const Eigen::Vector2d& n)
		{
			turned += mrpt::square((p - axis).x() * n.y() - (p - axis).y() * n.x());
			all += (p - axis).squaredNorm() * n.squaredNorm();
		});
	return turned < kSymmetric * all ? RotationSeen::AllButYaw : RotationSeen::All;
}

Matrix6d informationOf(
	const CloudPair& pair, const Eigen::Isometry3d& T, RotationSeen seen,
	const ObjectAlignerOptions& options)
{
	Matrix6d information = Matrix6d::Zero();
	information.topLeftCorner<3, 3>().setIdentity();
	information.topLeftCorner<3, 3>() /= mrpt::square(options.centreSigma) + pair.centreVariance;
	information.bottomRightCorner<3, 3>().setIdentity();
	information.bottomRightCorner<3, 3>() /= mrpt::square(options.rotationSigma);

	const auto found =
		findCorrespondences({&pair, &pair + 1}, T, options.endDistance, options.maxNormalAngle);
	const double scale = 1 / (mrpt::square(options.surfaceSigma) *
							  std::max(kEnough, static_cast<double>(found.items.size())));
	// The query's, of the target's vertical.
	const Eigen::Vector3d up = T.linear().row(2);
	for (const auto& item : found.items)
	{
		Vector6d jacobian = aboutPoint(pair, item, T, pair.queryCentre);
		if (seen == RotationSeen::None) jacobian.tail<3>().setZero();
		if (seen == RotationSeen::AllButYaw) jacobian.tail<3>() -= up.dot(jacobian.tail<3>()) * up;
		information.noalias() +=
			scale * tukey(item.residual, options.endDistance) * jacobian * jacobian.transpose();
	}
	return information;
}

Matrix6d jointCovariance(
	const CloudPairs& pairs, const Eigen::Isometry3d& T, const Eigen::Vector3d& middle,
	const ObjectAlignerOptions& options)
{
	const auto found = findCorrespondences(pairs, T, options.endDistance, options.maxNormalAngle);
	Matrix6d information = Matrix6d::Zero();
	const double scale = 1 / (mrpt::square(options.surfaceSigma) *
							  std::max(kEnough, static_cast<double>(found.items.size())));
	for (const auto& item : found.items)
	{
		const Vector6d jacobian = aboutPoint(*item.pair, item, T, middle);
		information.noalias() +=
			scale * tukey(item.residual, options.endDistance) * jacobian * jacobian.transpose();
	}
	for (const auto& pair : pairs)
	{
		const double centre =
			1 / ((mrpt::square(options.centreSigma) + pair.centreVariance) * pairs.count());
		for (int axis = 0; axis < 3; ++axis)
		{
			const Eigen::Vector3d direction = T.linear().row(axis);
			Vector6d jacobian;
			jacobian << direction, (pair.queryCentre - middle).cross(direction);
			information.noalias() += centre * jacobian * jacobian.transpose();
		}
	}
	const Eigen::Matrix3d tilt =
		T.linear().transpose() *
		Eigen::Vector3d(
			1 / mrpt::square(options.tiltSigma), 1 / mrpt::square(options.tiltSigma), kDamping)
			.asDiagonal() *
		T.linear();
	information.bottomRightCorner<3, 3>() += tilt;
	const Matrix6d covariance = mrpt::square(kJointSigma) * information.inverse();
	return 0.5 * (covariance + covariance.transpose());
}

}  // namespace semloop
