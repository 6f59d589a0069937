#pragma once

#include <semloop/object_map/TsdfBlocks.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>

namespace semloop
{
/** Largest integer not above a, for |a| < 2^31. */
inline int floorToInt(float a)
{
	const int i = static_cast<int>(a);
	return i - (a < static_cast<float>(i));
}

/** Reads voxels by their grid coordinates (voxel i is centred at i); remembers the last block. */
class TsdfSampler
{
public:
	static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

	explicit TsdfSampler(const TsdfBlocks& blocks) : blocks_(&blocks) {}

	/** nullptr where there is no block. */
	const TsdfBlock* block(const BlockIndex& index)
	{
		if (!(cached_ && index == cachedIndex_))
		{
			block_ = blocks_->find(index);
			cachedIndex_ = index;
			cached_ = true;
		}
		return block_;
	}

	struct Voxel
	{
		const TsdfBlock* block = nullptr;
		int voxel = 0;
		bool known() const { return block && block->known(voxel); }
		float distance() const { return known() ? block->distance[voxel] : unknown; }
	};

	Voxel at(int x, int y, int z)
	{
		return {block({x >> 3, y >> 3, z >> 3}), TsdfBlock::voxel(x & 7, y & 7, z & 7)};
	}
	Voxel nearest(const Eigen::Vector3f& q)
	{
		return at(floorToInt(q.x() + 0.5F), floorToInt(q.y() + 0.5F), floorToInt(q.z() + 0.5F));
	}

	/** Calls visit(voxel, trilinear weight) for the known ones of the 8 voxels round q. */
	template <typename Visit>
	void forNeighbours(const Eigen::Vector3f& q, const Visit& visit)
	{
		const int x = floorToInt(q.x()), y = floorToInt(q.y()), z = floorToInt(q.z());
		const float fx = q.x() - static_cast<float>(x), fy = q.y() - static_cast<float>(y),
					fz = q.z() - static_cast<float>(z);
		// The neighbours reach into the next block along the axes of these bits.
		const int crossing =
			((x & 7) == 7 ? 1 : 0) | ((y & 7) == 7 ? 2 : 0) | ((z & 7) == 7 ? 4 : 0);
		std::array<const TsdfBlock*, 8> blocks;
		blocks[0] = block({x >> 3, y >> 3, z >> 3});
		if (crossing == 0 && !blocks[0]) return;
		for (int c = 0; c < 8; ++c)
		{
			const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
			const int beyond = c & crossing;
			if (c > 0)
				blocks[c] = beyond != c
								? blocks[beyond]
								: blocks_->find({(x + dx) >> 3, (y + dy) >> 3, (z + dz) >> 3});
			const Voxel v{blocks[c], TsdfBlock::voxel((x + dx) & 7, (y + dy) & 7, (z + dz) & 7)};
			const float w = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) * (dz ? fz : 1 - fz);
			if (v.known()) visit(v, w);
		}
	}

	/** Trilinear over the known voxels; unknown where these have less than half of the weight. */
	float trilinear(const Eigen::Vector3f& q)
	{
		const int x = floorToInt(q.x()), y = floorToInt(q.y()), z = floorToInt(q.z());
		if ((x & 7) < 7 && (y & 7) < 7 && (z & 7) < 7)
		{
			const Voxel first = at(x, y, z);
			if (!first.block) return unknown;
			const Eigen::Vector3f fraction(
				q.x() - static_cast<float>(x), q.y() - static_cast<float>(y),
				q.z() - static_cast<float>(z));
			const float d = insideBlock(*first.block, first.voxel, fraction);
			if (!std::isnan(d)) return d;
		}
		float sum = 0, weight = 0;
		forNeighbours(
			q,
			[&](const Voxel& v, float w)
			{
				sum += w * v.block->distance[v.voxel];
				weight += w;
			});
		return weight < 0.5F ? unknown : sum / weight;
	}

private:
	/** The common case made quick: all 8 voxels in one block and in the band of the surface. */
	static float insideBlock(const TsdfBlock& block, int first, const Eigen::Vector3f& fraction)
	{
		constexpr int dy = TsdfBlock::voxel(0, 1, 0), dz = TsdfBlock::voxel(0, 0, 1);
		const float* const d = &block.distance[first];
		const int8_t* const e = &block.evidence[first];
		const auto least = [](int8_t a, int8_t b) { return a < b ? a : b; };
		const auto rowEvidence = [&](int i) { return least(e[i], e[i + 1]); };
		const int8_t evidence = least(
			least(rowEvidence(0), rowEvidence(dy)), least(rowEvidence(dz), rowEvidence(dz + dy)));
		if (evidence <= 0) return unknown;

		const auto lerp = [](float a, float b, float t) { return a + t * (b - a); };
		const auto row = [&](int i) { return lerp(d[i], d[i + 1], fraction.x()); };
		return lerp(
			lerp(row(0), row(dy), fraction.y()), lerp(row(dz), row(dz + dy), fraction.y()),
			fraction.z());
	}

	const TsdfBlocks* blocks_;
	const TsdfBlock* block_ = nullptr;
	BlockIndex cachedIndex_;
	bool cached_ = false;
};

}  // namespace semloop
