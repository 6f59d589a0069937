#include "TriangleTree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace semloop
{
namespace
{
using Eigen::Vector3d;

constexpr std::size_t kLeafSize = 4;

double squaredDistanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b)
{
	const Vector3d ab = b - a;
	const double length2 = ab.squaredNorm();
	const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
	return (p - a - t * ab).squaredNorm();
}
}  // namespace

TriangleTree::TriangleTree(const Surface& surface)
	: surface_(surface), order_(surface.triangles.size())
{
	std::iota(order_.begin(), order_.end(), std::size_t(0));
	build(0, order_.size());
}

TriangleTree::Box TriangleTree::boxOf(std::size_t triangle) const
{
	Box box;
	for (const uint32_t corner : surface_.triangles[triangle])
		box.extend(surface_.vertices[corner]);
	return box;
}

std::size_t TriangleTree::build(std::size_t begin, std::size_t end)
{
	const std::size_t index = nodes_.size();
	nodes_.emplace_back();
	Box box;
	for (std::size_t i = begin; i < end; i++) box.extend(boxOf(order_[i]));
	nodes_[index].box = box;
	nodes_[index].begin = begin;
	nodes_[index].end = end;
	if (end - begin <= kLeafSize) return index;

	Eigen::Index axis = 0;
	box.sizes().maxCoeff(&axis);
	const auto at = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
	const std::size_t middle = begin + (end - begin) / 2;
	std::nth_element(
		at(begin), at(middle), at(end),
		[&](std::size_t a, std::size_t b)
		{ return boxOf(a).center()[axis] < boxOf(b).center()[axis]; });
	const std::size_t left = build(begin, middle), right = build(middle, end);
	nodes_[index].left = left;
	nodes_[index].right = right;
	return index;
}

double TriangleTree::squaredDistance(const Vector3d& p, std::size_t triangle) const
{
	const auto& corners = surface_.triangles[triangle];
	const Vector3d &a = surface_.vertices[corners[0]], &b = surface_.vertices[corners[1]],
				   &c = surface_.vertices[corners[2]];
	const Vector3d normal = (b - a).cross(c - a);
	const auto isInside = [&](const Vector3d& from, const Vector3d& to)
	{ return (to - from).cross(p - from).dot(normal) >= 0; };
	// Over the triangle it is the distance to its plane, beside it that to its border.
	if (normal.squaredNorm() > 0 && isInside(a, b) && isInside(b, c) && isInside(c, a))
	{
		const double height = (p - a).dot(normal.normalized());
		return height * height;
	}
	return std::min(
		{squaredDistanceToSegment(p, a, b), squaredDistanceToSegment(p, b, c),
		 squaredDistanceToSegment(p, c, a)});
}

void TriangleTree::search(const Vector3d& point, std::size_t index, double& best) const
{
	const Node& node = nodes_[index];
	if (node.left == 0)
	{
		for (std::size_t i = node.begin; i < node.end; i++)
			best = std::min(best, squaredDistance(point, order_[i]));
		return;
	}
	std::pair<double, std::size_t> first{
		nodes_[node.left].box.squaredExteriorDistance(point), node.left};
	std::pair<double, std::size_t> second{
		nodes_[node.right].box.squaredExteriorDistance(point), node.right};
	if (second < first) std::swap(first, second);
	if (first.first < best) search(point, first.second, best);
	if (second.first < best) search(point, second.second, best);
}

double TriangleTree::distance(const Vector3d& point) const
{
	double best = std::numeric_limits<double>::infinity();
	search(point, 0, best);
	return std::sqrt(best);
}

}  // namespace semloop
