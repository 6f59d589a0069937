#pragma once

#include <semloop/loop_closure/ObjectAligner.h>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include <vector>

namespace semloop
{
/** Oriented points, one a column. */
struct Cloud
{
	Eigen::Matrix3Xd points;   //!< [m]
	Eigen::Matrix3Xd normals;  //!< unit length

	Eigen::Index size() const { return points.cols(); }
};

/** The mean point of every voxel; opposite sides of a thin object are kept apart. Ordered by voxel. */
Cloud thinned(const Cloud& cloud, double voxel);

/** Exact nearest neighbours in a cloud that is not empty. */
class NearestPoint
{
public:
	explicit NearestPoint(const Eigen::Matrix3Xd& points);
	~NearestPoint();
	NearestPoint(NearestPoint&&) noexcept;

	/** Index of the nearest point, when it is not further away than maxDistance. */
	std::optional<Eigen::Index> find(const Eigen::Vector3d& point, double maxDistance) const;

private:
	struct Tree;
	std::unique_ptr<Tree> tree_;
};

/** Two matched objects, thinned, in coordinates near the origin (see AlignmentProblem). */
struct CloudPair
{
	std::size_t index = 0;  //!< among the pairs given
	Cloud query, target;
	Eigen::Vector3d queryCentre, targetCentre;
	double centreVariance = 0;  //!< SurfacePair's
	NearestPoint nearestTarget;
};

/** Some of the pairs of a problem, side by side. */
struct CloudPairs
{
	const CloudPair* first = nullptr;
	const CloudPair* last = nullptr;  //!< one behind

	const CloudPair* begin() const { return first; }
	const CloudPair* end() const { return last; }
	double count() const { return static_cast<double>(last - first); }
	Eigen::Index queryPoints() const;
};

/** All pairs that have surfaces on both sides. Points are relative to an origin in each world. */
struct AlignmentProblem
{
	Eigen::Vector3d queryOrigin = Eigen::Vector3d::Zero();
	Eigen::Vector3d targetOrigin = Eigen::Vector3d::Zero();
	std::vector<CloudPair> pairs;

	CloudPairs all() const { return {pairs.data(), pairs.data() + pairs.size()}; }
	Eigen::Isometry3d toLocal(const mrpt::poses::CPose3D& T_target_query) const;
	mrpt::poses::CPose3D toWorld(const Eigen::Isometry3d& T_local) const;
};

AlignmentProblem makeProblem(
	const std::vector<SurfacePair>& pairs, const ObjectAlignerOptions& options);

/** Query points with a partner in the matched target object: near and of similar normal. */
struct Correspondences
{
	struct Item
	{
		const CloudPair* pair = nullptr;
		Eigen::Index query = 0, target = 0;
		Eigen::Vector3d point;  //!< the query's, in the target's frame
		double residual = 0;    //!< along the target's normal [m]
	};

	std::vector<Item> items;
	double rmse() const;  //!< of the residuals; 0 when empty [m]
};

Correspondences findCorrespondences(
	const CloudPairs& pairs, const Eigen::Isometry3d& T, double maxDistance, double maxNormalAngle);

struct Refinement
{
	Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
	int iterations = 0;
};

/** A rotation that is known beforehand. */
struct RotationPrior
{
	Eigen::Matrix3d expected = Eigen::Matrix3d::Identity();
	Eigen::Vector3d sigma = Eigen::Vector3d::Ones();  //!< about the target's x, y, z [rad]
};

/** Point-to-plane ICP over all these pairs, see ObjectAligner. */
Refinement refine(
	const CloudPairs& pairs, const Eigen::Isometry3d& start, const RotationPrior& prior,
	const ObjectAlignerOptions& options);

/** What the aligned surfaces of one pair say of its rotation. */
enum class RotationSeen
{
	All,
	AllButYaw,  //!< rotationally symmetric: all normals meet a vertical axis
	None        //!< barely seen
};
/** Symmetric: sum ((p x n)_z)^2 < 1/16 sum |p_xy|^2 |n_xy|^2 over the aligned points p, relative to the best axis,
 *  which is no further from the centre than the points are. A motion that leaves the point-to-plane distances as
 *  they are is the degenerate direction of the problem (J. Zhang, M. Kaess, S. Singh, On degeneracy of
 *  optimization-based state estimation problems, ICRA 2016), tested here for the one that furniture has. */
RotationSeen rotationSeen(
	const CloudPair& pair, const Eigen::Isometry3d& T, const ObjectAlignerOptions& options);

/** Hessian of the cost of one pair at T, for the motion that MatchAlignment describes, without what its surface
 *  does not see of the rotation. */
Eigen::Matrix<double, 6, 6> informationOf(
	const CloudPair& pair, const Eigen::Isometry3d& T, RotationSeen seen,
	const ObjectAlignerOptions& options);

/** Of a motion about `middle` as far as these pairs tell it, see ObjectAlignment::covariance. */
Eigen::Matrix<double, 6, 6> jointCovariance(
	const CloudPairs& pairs, const Eigen::Isometry3d& T, const Eigen::Vector3d& middle,
	const ObjectAlignerOptions& options);

/** FPFH matched within each pair, then RANSAC over all; empty when no model has 10 inliers. */
std::optional<Eigen::Isometry3d> alignFeatures(
	const CloudPairs& pairs, const ObjectAlignerOptions& options);

}  // namespace semloop
