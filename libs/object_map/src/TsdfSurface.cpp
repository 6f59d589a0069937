#include "TsdfSurface.h"

#include <cmath>

#include "TsdfSampler.h"

namespace semloop
{
BlockNeighborhood::BlockNeighborhood(const TsdfBlocks& blocks, const BlockIndex& centre)
{
	for (int dz = -1; dz <= 1; ++dz)
		for (int dy = -1; dy <= 1; ++dy)
			for (int dx = -1; dx <= 1; ++dx)
			{
				const auto* const block =
					blocks.find({centre.x + dx, centre.y + dy, centre.z + dz});
				blocks_[neighbor(8 * dx, 8 * dy, 8 * dz)] = block;
				// An edge ends in this block or in the next one along its axis.
				if (block && dx >= 0 && dy >= 0 && dz >= 0) hasSolid_ |= block->summary.solid;
			}
	if (hasSolid_) unpack();
}

void BlockNeighborhood::unpack()
{
	distances_.fill(TsdfSampler::unknown);
	for (int z = -1; z <= TsdfBlock::side + 1; ++z)
		for (int y = -1; y <= TsdfBlock::side + 1; ++y)
			for (int x = -1; x <= TsdfBlock::side + 1; ++x)
			{
				const auto* const block = blocks_[neighbor(x, y, z)];
				const int v = TsdfBlock::voxel(x & 7, y & 7, z & 7);
				if (block && block->known(v)) distances_[offset(x, y, z)] = block->distance[v];
			}
}

mrpt::img::TColor BlockNeighborhood::color(int x, int y, int z) const
{
	const auto& rgb = blocks_[neighbor(x, y, z)]->color[TsdfBlock::voxel(x & 7, y & 7, z & 7)];
	return {rgb[0], rgb[1], rgb[2]};
}

float BlockNeighborhood::difference(int at, int step) const
{
	const float here = distances_[at], before = distances_[at - step],
				after = distances_[at + step];
	if (!std::isnan(before) && !std::isnan(after)) return 0.5F * (after - before);
	if (!std::isnan(after)) return after - here;
	return std::isnan(before) ? 0.F : here - before;
}

mrpt::math::TVector3Df BlockNeighborhood::gradient(int x, int y, int z) const
{
	const int at = offset(x, y, z);
	return {difference(at, 1), difference(at, side), difference(at, side * side)};
}

namespace
{
/** Crossing between voxel a and its neighbour b along axis; distances are known, signs differ. */
SurfacePoint crossing(
	const BlockNeighborhood& n, const std::array<int, 3>& a, int axis, const BlockIndex& index,
	float voxelSize)
{
	auto b = a;
	++b[axis];
	const float da = n.distance(a[0], a[1], a[2]), db = n.distance(b[0], b[1], b[2]);
	const float t = da / (da - db);

	SurfacePoint point;
	const std::array<int, 3> origin{index.x, index.y, index.z};
	for (int i = 0; i < 3; ++i)
	{
		const auto cell = static_cast<float>(origin[i] * TsdfBlock::side + a[i]);
		point.position[i] = (cell + 0.5F + (i == axis ? t : 0.F)) * voxelSize;
	}
	const auto ga = n.gradient(a[0], a[1], a[2]), gb = n.gradient(b[0], b[1], b[2]);
	auto normal = ga * (1 - t) + gb * t;
	if (!(normal.norm() > 1e-3F * voxelSize))
	{
		normal = {0, 0, 0};
		normal[axis] = da < 0 ? 1.F : -1.F;
	}
	point.normal = normal * (1 / normal.norm());
	// The voxel inside was seen as the object; the one outside may never have got a colour.
	const auto& inside = da < 0 ? a : b;
	point.color = n.color(inside[0], inside[1], inside[2]);
	return point;
}
}  // namespace

EdgePoints edgePoints(const TsdfBlocks& blocks, float voxelSize)
{
	EdgePoints result;
	result.ofEdge.assign(EdgePoints::edge(blocks.size(), 0, 0), EdgePoints::none);
	for (std::size_t i = 0; i < blocks.size(); ++i)
	{
		const BlockNeighborhood n(blocks, blocks[i].index);
		if (!n.hasSolid()) continue;
		for (int v = 0; v < TsdfBlock::voxels; ++v)
		{
			const std::array<int, 3> a{v % 8, v / 8 % 8, v / 64};
			const float da = n.distance(a[0], a[1], a[2]);
			if (std::isnan(da)) continue;
			for (int axis = 0; axis < 3; ++axis)
			{
				auto b = a;
				++b[axis];
				const float db = n.distance(b[0], b[1], b[2]);
				if (std::isnan(db) || (da < 0) == (db < 0)) continue;
				result.ofEdge[EdgePoints::edge(i, v, axis)] =
					static_cast<uint32_t>(result.points.size());
				result.points.push_back(crossing(n, a, axis, blocks[i].index, voxelSize));
			}
		}
	}
	return result;
}

std::vector<SurfacePoint> TsdfVolume::surface() const
{
	return edgePoints(blocks_, static_cast<float>(options_.voxelSize)).points;
}

}  // namespace semloop
