#pragma once

#include <semloop/object_map/TsdfVolume.h>

#include <limits>

namespace semloop
{
/** Surface points on the voxel edges, findable by their edge: the edge along an axis that starts at a
 *  voxel. */
struct EdgePoints
{
	static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();
	static std::size_t edge(std::size_t block, int voxel, int axis)
	{
		return (block * TsdfBlock::voxels + voxel) * 3 + axis;
	}

	std::vector<SurfacePoint> points;
	std::vector<uint32_t> ofEdge;  //!< index into points, or none
};

EdgePoints edgePoints(const TsdfBlocks& blocks, float voxelSize);

/** A block and one voxel before it and two behind it along each axis, unpacked from the neighbours:
 *  coordinates -1 ... 9 count from the block's first voxel. NaN where the distance is not known. */
class BlockNeighborhood
{
public:
	BlockNeighborhood(const TsdfBlocks& blocks, const BlockIndex& centre);

	float distance(int x, int y, int z) const { return distances_[offset(x, y, z)]; }
	/** Of a voxel whose distance is known. */
	mrpt::img::TColor color(int x, int y, int z) const;
	/** Not normalised; components without a known neighbour are zero. */
	mrpt::math::TVector3Df gradient(int x, int y, int z) const;
	/** False when no edge that starts in the block can cross the surface. */
	bool hasSolid() const { return hasSolid_; }

private:
	static constexpr int side = TsdfBlock::side + 3;
	static int offset(int x, int y, int z) { return ((z + 1) * side + y + 1) * side + x + 1; }
	static int neighbor(int x, int y, int z)
	{
		return (((z >> 3) + 1) * 3 + (y >> 3) + 1) * 3 + (x >> 3) + 1;
	}
	float difference(int at, int step) const;
	void unpack();

	std::array<const TsdfBlock*, 27> blocks_{};
	std::array<float, side * side * side> distances_;
	bool hasSolid_ = false;
};

}  // namespace semloop
