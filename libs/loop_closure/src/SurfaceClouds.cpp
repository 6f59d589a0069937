#include "SurfaceClouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numeric>

namespace semloop
{
namespace
{
/** Voxel coordinates, and the side (0 ... 5) that the normal points to most. */
using Cell = std::array<int64_t, 4>;

Cell cellOf(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double voxel)
{
	Eigen::Index axis = 0;
	normal.cwiseAbs().maxCoeff(&axis);
	Cell cell;
	for (int i = 0; i < 3; ++i) cell[i] = static_cast<int64_t>(std::floor(point[i] / voxel));
	cell[3] = 2 * axis + (normal[axis] < 0);
	return cell;
}

Eigen::Vector3d toEigen(const mrpt::math::TPoint3D& p)
{
	return {p.x, p.y, p.z};
}

Cloud toCloud(const std::vector<SurfacePoint>& surface, const Eigen::Vector3d& origin)
{
	Cloud cloud;
	cloud.points.resize(3, static_cast<Eigen::Index>(surface.size()));
	cloud.normals.resizeLike(cloud.points);
	Eigen::Index used = 0;
	for (const auto& [p, n, color] : surface)
	{
		const Eigen::Vector3d point(p.x, p.y, p.z), normal(n.x, n.y, n.z);
		if (!point.allFinite() || !normal.allFinite() || normal.norm() < 0.5) continue;
		cloud.points.col(used) = point - origin;
		cloud.normals.col(used++) = normal.normalized();
	}
	cloud.points.conservativeResize(3, used);
	cloud.normals.conservativeResize(3, used);
	return cloud;
}

/** Every n-th point, so that a fixed number is left of all clouds together. */
Cloud decimated(const Cloud& cloud, Eigen::Index stride)
{
	const auto kept = Eigen::seq(Eigen::Index(0), cloud.size() - 1, stride);
	return {cloud.points(Eigen::all, kept), cloud.normals(Eigen::all, kept)};
}

Eigen::Vector3d meanCentre(
	const std::vector<SurfacePair>& pairs, mrpt::math::TPoint3D SurfacePair::*centre)
{
	Eigen::Vector3d sum = Eigen::Vector3d::Zero();
	for (const auto& pair : pairs) sum += toEigen(pair.*centre);
	return pairs.empty() ? sum : sum / static_cast<double>(pairs.size());
}
}  // namespace

Cloud thinned(const Cloud& cloud, double voxel)
{
	std::vector<std::pair<Cell, Eigen::Index>> order;
	for (Eigen::Index i = 0; i < cloud.size(); ++i)
		order.emplace_back(cellOf(cloud.points.col(i), cloud.normals.col(i), voxel), i);
	std::sort(order.begin(), order.end());

	Cloud result;
	result.points.resize(3, cloud.size());
	result.normals.resize(3, cloud.size());
	Eigen::Index used = 0;
	for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)
	{
		Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
		for (; end < order.size() && order[end].first == order[begin].first; ++end)
		{
			point += cloud.points.col(order[end].second);
			normal += cloud.normals.col(order[end].second);
		}
		result.points.col(used) = point / static_cast<double>(end - begin);
		result.normals.col(used++) = normal.normalized();  // one side: they cannot cancel out
	}
	result.points.conservativeResize(3, used);
	result.normals.conservativeResize(3, used);
	return result;
}

namespace
{
/** The nearest one, of those within a distance: branches further away are never looked at. */
class NearestWithin
{
public:
	explicit NearestWithin(float squaredDistance) : squaredDistance_(squaredDistance) {}

	/** Of a whole leaf, also what is further than the last one. */
	bool addPoint(float squaredDistance, Eigen::Index index)
	{
		if (squaredDistance >= squaredDistance_) return true;
		squaredDistance_ = squaredDistance;
		index_ = index;
		return true;
	}
	float worstDist() const { return squaredDistance_; }
	bool full() const { return true; }
	void sort() {}  // nanoflann from 1.5 on asks for it
	std::size_t size() const { return index_ ? 1 : 0; }

	std::optional<Eigen::Index> index() const { return index_; }

private:
	float squaredDistance_;
	std::optional<Eigen::Index> index_;
};
}  // namespace

struct NearestPoint::Tree
{
	// What nanoflann asks of its points.
	std::size_t kdtree_get_point_count() const { return std::size_t(points.cols()); }
	float kdtree_get_pt(Eigen::Index i, std::size_t axis) const
	{
		return points(Eigen::Index(axis), i);
	}
	template <class Box>
	bool kdtree_get_bbox(Box&) const
	{
		return false;
	}

	explicit Tree(const Eigen::Matrix3Xd& all) : points(all.cast<float>()), index(3, *this) {}

	const Eigen::Matrix3Xf points;
	nanoflann::KDTreeSingleIndexAdaptor<
		nanoflann::L2_Simple_Adaptor<float, Tree>, Tree, 3, Eigen::Index>
		index;
};

NearestPoint::NearestPoint(const Eigen::Matrix3Xd& points) : tree_(std::make_unique<Tree>(points))
{
}

NearestPoint::~NearestPoint() = default;
NearestPoint::NearestPoint(NearestPoint&&) noexcept = default;

std::optional<Eigen::Index> NearestPoint::find(
	const Eigen::Vector3d& point, double maxDistance) const
{
	const Eigen::Vector3f p = point.cast<float>();
	// Nearer than this, so that maxDistance itself is within.
	NearestWithin nearest(
		std::nextafter(float(maxDistance * maxDistance), std::numeric_limits<float>::max()));
	tree_->index.findNeighbors(nearest, p.data(), {});
	return nearest.index();
}

Eigen::Index CloudPairs::queryPoints() const
{
	Eigen::Index sum = 0;
	for (const auto& pair : *this) sum += pair.query.size();
	return sum;
}

Eigen::Isometry3d AlignmentProblem::toLocal(const mrpt::poses::CPose3D& T_target_query) const
{
	const Eigen::Isometry3d T(Eigen::Matrix4d(
		T_target_query.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen()));
	return Eigen::Translation3d(-targetOrigin) * T * Eigen::Translation3d(queryOrigin);
}

mrpt::poses::CPose3D AlignmentProblem::toWorld(const Eigen::Isometry3d& T_local) const
{
	const Eigen::Isometry3d T =
		Eigen::Translation3d(targetOrigin) * T_local * Eigen::Translation3d(-queryOrigin);
	return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(T.matrix()));
}

AlignmentProblem makeProblem(
	const std::vector<SurfacePair>& pairs, const ObjectAlignerOptions& options)
{
	AlignmentProblem problem;
	problem.queryOrigin = meanCentre(pairs, &SurfacePair::queryCentre);
	problem.targetOrigin = meanCentre(pairs, &SurfacePair::targetCentre);
	for (std::size_t i = 0; i < pairs.size(); ++i)
	{
		const auto& pair = pairs[i];
		Cloud query = thinned(toCloud(pair.query, problem.queryOrigin), options.queryVoxel);
		Cloud target = thinned(toCloud(pair.target, problem.targetOrigin), options.targetVoxel);
		if (query.size() == 0 || target.size() == 0) continue;
		NearestPoint nearest(target.points);
		problem.pairs.push_back(
			{i, std::move(query), std::move(target),
			 toEigen(pair.queryCentre) - problem.queryOrigin,
			 toEigen(pair.targetCentre) - problem.targetOrigin, pair.centreVariance,
			 std::move(nearest)});
	}
	const Eigen::Index limit = options.maxQueryPoints;
	const Eigen::Index stride = (problem.all().queryPoints() + limit - 1) / limit;
	if (stride > 1)
		for (auto& pair : problem.pairs) pair.query = decimated(pair.query, stride);
	return problem;
}

}  // namespace semloop
