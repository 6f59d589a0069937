#include <semloop/evaluation/UprightBox.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace semloop
{
namespace
{
using Polygon = std::vector<Eigen::Vector2d>;

double volumeOf(const UprightBox& box)
{
	return box.size.x * box.size.y * box.size.z;
}

/** The corners seen from `origin`, counter-clockwise. */
Polygon footprint(const UprightBox& box, const mrpt::math::TPoint3D& origin)
{
	const Eigen::Vector2d centre(box.centre.x - origin.x, box.centre.y - origin.y);
	const Eigen::Vector2d u =
		0.5 * box.size.x * Eigen::Vector2d(std::cos(box.yaw), std::sin(box.yaw));
	const Eigen::Vector2d v =
		0.5 * box.size.y * Eigen::Vector2d(-std::sin(box.yaw), std::cos(box.yaw));
	return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
	return a.x() * b.y() - a.y() * b.x();
}

/** The part of a polygon to the left of the line from a to b. */
Polygon clipped(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
	Polygon result;
	for (std::size_t i = 0; i < polygon.size(); i++)
	{
		const Eigen::Vector2d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
		const double left = cross(b - a, p - a), nextLeft = cross(b - a, q - a);
		if (left >= 0) result.push_back(p);
		if ((left >= 0) != (nextLeft >= 0))
			result.push_back(p + (q - p) * (left / (left - nextLeft)));
	}
	return result;
}

double areaOf(const Polygon& polygon)
{
	double twice = 0;
	for (std::size_t i = 0; i < polygon.size(); i++)
		twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
	return 0.5 * twice;
}

double sharedArea(const UprightBox& a, const UprightBox& b)
{
	Polygon polygon = footprint(a, a.centre);
	const Polygon sides = footprint(b, a.centre);
	for (std::size_t i = 0; i < sides.size(); i++)
		polygon = clipped(polygon, sides[i], sides[(i + 1) % sides.size()]);
	return std::max(0.0, areaOf(polygon));
}

double sharedHeight(const UprightBox& a, const UprightBox& b)
{
	const double top = std::min(a.centre.z + a.size.z / 2, b.centre.z + b.size.z / 2);
	const double bottom = std::max(a.centre.z - a.size.z / 2, b.centre.z - b.size.z / 2);
	return std::max(0.0, top - bottom);
}
}  // namespace

bool contains(const UprightBox& box, const mrpt::math::TPoint3D& point)
{
	const auto d = point - box.centre;
	const double x = std::cos(box.yaw) * d.x + std::sin(box.yaw) * d.y;
	const double y = -std::sin(box.yaw) * d.x + std::cos(box.yaw) * d.y;
	return 2 * std::abs(x) <= box.size.x && 2 * std::abs(y) <= box.size.y &&
		   2 * std::abs(d.z) <= box.size.z;
}

double intersectionOverUnion(const UprightBox& a, const UprightBox& b)
{
	if (!(volumeOf(a) > 0) || !(volumeOf(b) > 0)) return 0;
	const double shared = sharedArea(a, b) * sharedHeight(a, b);
	return shared / (volumeOf(a) + volumeOf(b) - shared);
}

}  // namespace semloop
