#include <semloop/object_map/TsdfBlocks.h>

#include <algorithm>

namespace semloop
{
namespace
{
// A spilled mask leaves voxels that were seen inside of it once or twice.
constexpr int enoughEvidence = 8;

void count(TsdfBlock::Slice& slice, const TsdfBlock::Slice& voxels)
{
	slice.depthSum += voxels.depthSum;
	slice.count += voxels.count;
}

void extend(TsdfBlock::Summary& summary, int axis, int low, int high)
{
	summary.solidMin[axis] = std::min(summary.solidMin[axis], static_cast<int8_t>(low));
	summary.solidMax[axis] = std::max(summary.solidMax[axis], static_cast<int8_t>(high));
}
}  // namespace

void TsdfBlock::summarize(float skin)
{
	summary = {};
	summary.solidMin.fill(side);
	summary.solidMax.fill(-1);
	for (int row = 0; row < side * side; ++row)
	{
		bool anyNegative = false;
		for (int x = 0; x < side; ++x) anyNegative |= distance[row * side + x] < 0;
		if (!anyNegative) continue;

		int low = side, high = -1;
		Slice ofRow;
		for (int x = 0; x < side; ++x)
		{
			const int v = row * side + x;
			if (!solid(v)) continue;
			low = std::min(low, x);
			high = x;
			if (distance[v] <= -skin) continue;
			const int times = std::min<int>(evidence[v], enoughEvidence);
			count(summary.slices[0][x], {-distance[v] * float(times), times});
			count(ofRow, {-distance[v] * float(times), times});
		}
		if (high < 0) continue;
		summary.solid = true;
		extend(summary, 0, low, high);
		extend(summary, 1, row % side, row % side);
		extend(summary, 2, row / side, row / side);
		count(summary.slices[1][row % side], ofRow);
		count(summary.slices[2][row / side], ofRow);
	}
}

TsdfBlock& TsdfBlocks::findOrAdd(const BlockIndex& index)
{
	if (auto* const block = find(index)) return *block;
	blocks_.emplace_back();
	blocks_.back().index = index;
	if (slots_.size() < 2 * blocks_.size())
	{
		rebuildIndex();
	}
	else
	{
		slots_[slot(key(index))] = {key(index), static_cast<uint32_t>(blocks_.size() - 1)};
	}
	return blocks_.back();
}

void TsdfBlocks::rebuildIndex()
{
	std::size_t capacity = 64;
	while (capacity < 4 * blocks_.size()) capacity *= 2;
	slots_.assign(capacity, {});
	for (std::size_t i = 0; i < blocks_.size(); ++i)
	{
		const uint64_t k = key(blocks_[i].index);
		slots_[slot(k)] = {k, static_cast<uint32_t>(i)};
	}
}

void TsdfBlocks::clear()
{
	blocks_.clear();
	slots_.clear();
}

std::size_t TsdfBlocks::memoryBytes() const
{
	return blocks_.size() * sizeof(TsdfBlock) + slots_.capacity() * sizeof(Slot);
}

}  // namespace semloop
