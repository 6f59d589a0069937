#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "TsdfSurface.h"

namespace semloop
{
namespace
{
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Edge 4 axis + n runs along axis, n counts
// the two other coordinates of its lower corner.
using Triangles = std::vector<std::array<int, 3>>;

int lowerCorner(int edge)
{
	const int axis = edge / 4, n = edge % 4;
	const int second = (axis + 1) % 3, third = (axis + 2) % 3;
	return (n & 1) << second | (n >> 1) << third;
}

int edgeBetween(int a, int b)
{
	const int bit = a ^ b;
	const int axis = bit == 1 ? 0 : bit == 2 ? 1 : 2;
	const int low = std::min(a, b);
	return 4 * axis + ((low >> (axis + 1) % 3 & 1) | (low >> (axis + 2) % 3 & 1) << 1);
}

/** Corners of face (axis, high), counter-clockwise seen from outside the cell. */
std::array<int, 4> faceCorners(int axis, bool high)
{
	const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
	const int base = high ? 1 << axis : 0;
	if (high) return {base, base | u, base | u | v, base | v};
	return {base, base | v, base | u | v, base | u};
}

bool onOneFace(int edgeA, int edgeB)
{
	for (int axis = 0; axis < 3; ++axis)
	{
		if (edgeA / 4 == axis || edgeB / 4 == axis) continue;
		if ((lowerCorner(edgeA) ^ lowerCorner(edgeB)) >> axis & 1) continue;
		return true;
	}
	return false;
}

/** Splits the polygon first ... last of a loop of edges into triangles none of whose inner sides lies
 *  in a face of the cell: the neighbour could have the same side there, and the mesh would not be
 *  a manifold. */
bool splitPolygon(const std::vector<int>& loop, std::size_t first, std::size_t last, Triangles& out)
{
	if (last - first < 2) return true;
	for (std::size_t middle = first + 1; middle < last; ++middle)
	{
		if (middle > first + 1 && onOneFace(loop[first], loop[middle])) continue;
		if (middle + 1 < last && onOneFace(loop[middle], loop[last])) continue;
		const std::size_t before = out.size();
		out.push_back({loop[first], loop[middle], loop[last]});
		if (splitPolygon(loop, first, middle, out) && splitPolygon(loop, middle, last, out))
			return true;
		out.resize(before);
	}
	return false;
}

/** Triangles (as triples of edges) of a cell whose inside corners are the bits set. On each face the
 *  contour is walked with every inside corner, or run of them, cut off by itself: that depends on
 *  the face's own signs only, so neighbouring cells agree. The segments then close to loops. */
Triangles trianglesOf(int inside)
{
	std::array<int, 12> next;
	next.fill(-1);
	for (int face = 0; face < 6; ++face)
	{
		const auto corners = faceCorners(face / 2, face % 2 != 0);
		const auto isInside = [&](int i) { return (inside >> corners[i % 4] & 1) != 0; };
		for (int i = 0; i < 4; ++i)
		{
			if (isInside(i) || !isInside(i + 1)) continue;
			int j = i + 1;
			while (isInside(j + 1)) ++j;
			next[edgeBetween(corners[i], corners[(i + 1) % 4])] =
				edgeBetween(corners[j % 4], corners[(j + 1) % 4]);
		}
	}
	Triangles result;
	for (int start = 0; start < 12; ++start)
	{
		std::vector<int> loop;
		for (int e = start; next[e] >= 0;)
		{
			loop.push_back(e);
			e = std::exchange(next[e], -1);
		}
		if (!loop.empty()) splitPolygon(loop, 0, loop.size() - 1, result);
	}
	return result;
}

const std::array<Triangles, 256>& triangleTable()
{
	static const auto table = []
	{
		std::array<Triangles, 256> cases;
		for (int inside = 0; inside < 256; ++inside) cases[inside] = trianglesOf(inside);
		return cases;
	}();
	return table;
}

/** Adds the triangles of the cells whose lower corners lie in one block. */
class CellMesher
{
public:
	CellMesher(const TsdfBlocks& blocks, const EdgePoints& edges, TriangleMesh& mesh)
		: blocks_(blocks), edges_(edges), mesh_(mesh)
	{
	}

	void addBlock(std::size_t position)
	{
		const BlockIndex centre = blocks_[position].index;
		const BlockNeighborhood n(blocks_, centre);
		if (!n.hasSolid()) return;
		for (int i = 0; i < 8; ++i)
			positions_[i] = blocks_.position(
				{centre.x + (i & 1), centre.y + (i >> 1 & 1), centre.z + (i >> 2)});
		for (int v = 0; v < TsdfBlock::voxels; ++v) addCell(n, {v % 8, v / 8 % 8, v / 64});
	}

private:
	void addCell(const BlockNeighborhood& n, const std::array<int, 3>& at)
	{
		int inside = 0;
		for (int c = 0; c < 8; ++c)
		{
			const float d = n.distance(at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2));
			if (std::isnan(d)) return;
			inside |= (d < 0 ? 1 : 0) << c;
		}
		for (const auto& triangle : triangleTable()[inside])
			mesh_.triangles.push_back(
				{point(at, triangle[0]), point(at, triangle[1]), point(at, triangle[2])});
	}

	uint32_t point(const std::array<int, 3>& at, int edge) const
	{
		const int corner = lowerCorner(edge);
		const int x = at[0] + (corner & 1), y = at[1] + (corner >> 1 & 1),
				  z = at[2] + (corner >> 2);
		const auto block = positions_[(x >> 3) | (y >> 3) << 1 | (z >> 3) << 2];
		return edges_
			.ofEdge[EdgePoints::edge(block, TsdfBlock::voxel(x & 7, y & 7, z & 7), edge / 4)];
	}

	const TsdfBlocks& blocks_;
	const EdgePoints& edges_;
	TriangleMesh& mesh_;
	std::array<std::size_t, 8> positions_{};  // of the block and its neighbours towards +x, +y, +z
};

/** Drops the vertices that no triangle has, keeping the order. */
void dropUnused(TriangleMesh& mesh)
{
	std::vector<uint32_t> renamed(mesh.vertices.size(), EdgePoints::none);
	for (const auto& triangle : mesh.triangles)
		for (const uint32_t v : triangle) renamed[v] = 0;
	uint32_t count = 0;
	for (std::size_t v = 0; v < renamed.size(); ++v)
	{
		if (renamed[v] == EdgePoints::none) continue;
		mesh.vertices[count] = mesh.vertices[v];
		renamed[v] = count++;
	}
	mesh.vertices.resize(count);
	for (auto& triangle : mesh.triangles)
		for (uint32_t& v : triangle) v = renamed[v];
}

}  // namespace

TriangleMesh TsdfVolume::mesh() const
{
	EdgePoints edges = edgePoints(blocks_, static_cast<float>(options_.voxelSize));
	TriangleMesh mesh;
	CellMesher mesher(blocks_, edges, mesh);
	for (std::size_t i = 0; i < blocks_.size(); ++i) mesher.addBlock(i);
	mesh.vertices = std::move(edges.points);
	dropUnused(mesh);
	return mesh;
}

}  // namespace semloop
