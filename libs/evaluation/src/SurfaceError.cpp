#include <semloop/config/Error.h>
#include <semloop/evaluation/SurfaceError.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "TriangleTree.h"

namespace semloop
{
std::vector<double> distancesToSurface(
	const std::vector<Eigen::Vector3d>& points, const Surface& surface)
{
	if (surface.triangles.empty())
		throw InputError("the true surface has no triangle: give a mesh, not a point cloud");
	const TriangleTree tree(surface);
	std::vector<double> distances;
	distances.reserve(points.size());
	for (const auto& point : points) distances.push_back(tree.distance(point));
	return distances;
}

std::vector<double> surfaceErrors(
	const Surface& estimate, const Surface& truth, const mrpt::poses::CPose3D& T_truth_estimate)
{
	std::vector<Eigen::Vector3d> points;
	points.reserve(estimate.vertices.size());
	for (const auto& v : estimate.vertices)
	{
		const auto p = T_truth_estimate.composePoint(mrpt::math::TPoint3D(v.x(), v.y(), v.z()));
		points.emplace_back(p.x, p.y, p.z);
	}
	return distancesToSurface(points, truth);
}

SurfaceError summarizeSurfaceErrors(std::vector<double> distances)
{
	SurfaceError result;
	if (distances.empty()) return result;
	std::sort(distances.begin(), distances.end());
	const auto rank = std::size_t(std::ceil(0.95 * double(distances.size())));
	result.percentile95 = distances[std::max<std::size_t>(rank, 1) - 1];
	result.distance = summarizeErrors(std::move(distances));
	return result;
}

}  // namespace semloop
