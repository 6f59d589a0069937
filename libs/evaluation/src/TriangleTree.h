#pragma once

#include <semloop/evaluation/PlyFile.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace semloop
{
/** Nearest point of a set of triangles: a binary tree of boxes, split at the median of the longest side,
 *  searched nearest box first. O(log n) for most questions. */
class TriangleTree
{
public:
	/** The surface must stay; it has at least one triangle. */
	explicit TriangleTree(const Surface& surface);

	/** Distance to the nearest triangle [m]. */
	double distance(const Eigen::Vector3d& point) const;

private:
	using Box = Eigen::AlignedBox3d;

	struct Node
	{
		Box box;
		std::size_t begin = 0, end = 0;   //!< in order_
		std::size_t left = 0, right = 0;  //!< 0: a leaf
	};

	std::size_t build(std::size_t begin, std::size_t end);
	Box boxOf(std::size_t triangle) const;
	double squaredDistance(const Eigen::Vector3d& point, std::size_t triangle) const;
	void search(const Eigen::Vector3d& point, std::size_t node, double& best) const;

	const Surface& surface_;
	std::vector<std::size_t> order_;
	std::vector<Node> nodes_;
};

}  // namespace semloop
