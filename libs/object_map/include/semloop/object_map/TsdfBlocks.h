#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace semloop
{
/** Place of a block: its voxels are [8 x, 8 x + 8) along x, and the same along y and z. */
struct BlockIndex
{
	int32_t x = 0, y = 0, z = 0;
	bool operator==(const BlockIndex& o) const { return x == o.x && y == o.y && z == o.z; }

	/** Blocks lie within [-limit, limit) of the origin along each axis. */
	static constexpr int32_t limit = 4096;
	bool valid() const
	{
		// Shifted to [0, 2 limit), a power of two; what lies outside has a higher bit.
		const auto bits = [](int32_t a) { return static_cast<uint32_t>(a) + limit; };
		return (bits(x) | bits(y) | bits(z)) < 2 * limit;
	}
};

/** 8 x 8 x 8 voxels, 12 bytes each, stored field by field so that rows of 8 can be processed at
 *  once. The centre of voxel (i, j, k), counted over all blocks, lies at (i + 0.5, j + 0.5, k + 0.5)
 *  times the voxel size. */
struct TsdfBlock
{
	static constexpr int side = 8;
	static constexpr int voxels = side * side * side;
	static constexpr int voxel(int x, int y, int z) { return (z * side + y) * side + x; }

	/** The voxels of one slice (perpendicular to an axis) that lie just inside the surface, each
	 *  counted as often as it was seen inside the mask more than outside, 8 times at most. */
	struct Slice
	{
		float depthSum = 0;  //!< of their depths below the surface [m]
		int count = 0;
	};
	/** What the voxels say in short; refreshed by summarize(). */
	struct Summary
	{
		bool solid = false;  //!< has a voxel inside the object
		std::array<int8_t, 3> solidMin{},
			solidMax{};  //!< range of those voxels, both ends included
		std::array<std::array<Slice, side>, 3> slices{};  //!< per axis
	};

	/** Distance of a voxel that was never measured; it marks itself, so that readers need no weight. */
	static constexpr float unmeasured = 1e9F;

	TsdfBlock() { distance.fill(unmeasured); }

	/** Measured, and not on a surface that was mostly seen outside the object's mask. */
	bool known(int v) const { return distance[v] < 0 ? evidence[v] > 0 : distance[v] < unmeasured; }
	/** Measured to be inside the object. */
	bool solid(int v) const { return distance[v] < 0 && evidence[v] > 0; }

	/** Recomputes the summary; voxels less than skin [m] below the surface count in the slices. */
	void summarize(float skin);

	BlockIndex index;
	std::array<float, voxels> distance;  //!< signed, truncated, positive outside; or unmeasured [m]
	std::array<float, voxels> weight{};  //!< 0 = never measured
	std::array<std::array<uint8_t, 3>, voxels> color{};  //!< R, G, B
	/** Times seen inside the mask - outside it, in [-127, 127]. */
	std::array<int8_t, voxels> evidence{};
	Summary summary;
};

/** Blocks in the order in which they came, found by their place (open addressing). */
class TsdfBlocks
{
public:
	/** nullptr where there is no block. */
	const TsdfBlock* find(const BlockIndex& index) const
	{
		const std::size_t i = position(index);
		return i < size() ? &blocks_[i] : nullptr;
	}
	TsdfBlock* find(const BlockIndex& index)
	{
		const std::size_t i = position(index);
		return i < size() ? &blocks_[i] : nullptr;
	}
	/** The index must be valid(). References to blocks stay good until removeIf() or clear(). */
	TsdfBlock& findOrAdd(const BlockIndex& index);

	/** Keeps the order of the others. */
	template <typename Predicate>
	void removeIf(const Predicate& unwanted)
	{
		std::deque<TsdfBlock> kept;
		for (auto& block : blocks_)
			if (!unwanted(block)) kept.push_back(block);
		blocks_.swap(kept);
		rebuildIndex();
	}
	void clear();

	std::size_t size() const { return blocks_.size(); }
	bool empty() const { return blocks_.empty(); }
	std::size_t memoryBytes() const;

	const TsdfBlock& operator[](std::size_t i) const { return blocks_[i]; }
	auto begin() { return blocks_.begin(); }
	auto end() { return blocks_.end(); }
	auto begin() const { return blocks_.begin(); }
	auto end() const { return blocks_.end(); }

	/** Position in the order above; size() where there is no block. */
	std::size_t position(const BlockIndex& index) const
	{
		if (slots_.empty() || !index.valid()) return size();
		const auto& found = slots_[slot(key(index))];
		return found.key == emptyKey ? size() : found.position;
	}

private:
	struct Slot
	{
		uint64_t key = emptyKey;
		uint32_t position = 0;
	};
	static constexpr uint64_t emptyKey = ~uint64_t{0};
	static uint64_t key(const BlockIndex& index)
	{
		const auto part = [](int32_t a) { return static_cast<uint64_t>(a + BlockIndex::limit); };
		return part(index.x) | part(index.y) << 20 | part(index.z) << 40;
	}
	/** Where the key is, or would be put. */
	std::size_t slot(uint64_t key) const
	{
		// Fibonacci hashing; the high bits are the mixed ones.
		const std::size_t mask = slots_.size() - 1;
		std::size_t i = (key * 0x9E3779B97F4A7C15ULL >> 40) & mask;
		while (slots_[i].key != key && slots_[i].key != emptyKey) i = (i + 1) & mask;
		return i;
	}
	void rebuildIndex();

	std::deque<TsdfBlock> blocks_;
	std::vector<Slot> slots_;  // a power of two, at most half full
};

}  // namespace semloop
