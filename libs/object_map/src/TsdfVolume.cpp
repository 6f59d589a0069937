#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>

#include "TsdfSampler.h"

namespace semloop
{
namespace
{
using mrpt::math::TPoint3Df;

constexpr double trimmedShare = 0.01;  // of the surface, at each end of an axis

/** Low and high end along one axis: the slice where the trimmed share is passed, and from its
 *  centre the mean depth outwards to the surface. Empty when the slices are. */
std::optional<std::pair<double, double>> trimmedRange(
	const std::vector<TsdfBlock::Slice>& slices, int firstSlice, double voxelSize)
{
	double total = 0;
	for (const auto& slice : slices) total += slice.count;
	if (total == 0) return std::nullopt;

	const auto end = [&](bool high)
	{
		double passed = 0;
		for (std::size_t n = 0;; ++n)
		{
			const std::size_t i = high ? slices.size() - 1 - n : n;
			passed += slices[i].count;
			if (slices[i].count == 0 || passed < trimmedShare * total) continue;
			const double centre = (firstSlice + static_cast<double>(i) + 0.5) * voxelSize;
			const double depth = slices[i].depthSum / slices[i].count;
			return high ? centre + depth : centre - depth;
		}
	};
	return std::pair{end(false), end(true)};
}

int component(const BlockIndex& index, int axis)
{
	return axis == 0 ? index.x : axis == 1 ? index.y : index.z;
}

bool usable(const TsdfOptions& o)
{
	const bool finite =
		std::isfinite(o.voxelSize) && std::isfinite(o.truncation) && std::isfinite(o.maxWeight);
	return finite && o.voxelSize > 0 && o.truncation >= o.voxelSize && o.maxWeight > 0 &&
		   o.maxBlocks > 0;
}

}  // namespace

TsdfVolume::TsdfVolume(const TsdfOptions& options) : options_(options)
{
	if (!usable(options))
		throw UsageError(
			"TSDF volume: needs voxelSize > 0, truncation >= voxelSize, maxWeight > 0 and "
			"maxBlocks > 0");
}

TsdfBlock* TsdfVolume::allocate(const BlockIndex& index)
{
	if (!index.valid()) return nullptr;
	if (auto* const block = blocks_.find(index)) return block;
	if (blocks_.size() >= static_cast<std::size_t>(options_.maxBlocks)) return nullptr;
	return &blocks_.findOrAdd(index);
}

void TsdfVolume::makeRoom()
{
	if (blocks_.size() < static_cast<std::size_t>(options_.maxBlocks)) return;
	blocks_.removeIf([](const TsdfBlock& block) { return !block.summary.solid; });
}

void TsdfVolume::summarize(TsdfBlock& block) const
{
	block.summarize(static_cast<float>(1.5 * options_.voxelSize));
}

std::optional<mrpt::math::TBoundingBox> TsdfVolume::boundingBox() const
{
	mrpt::math::TBoundingBox box({0, 0, 0}, {0, 0, 0});
	for (int axis = 0; axis < 3; ++axis)
	{
		int first = BlockIndex::limit, last = -BlockIndex::limit;
		for (const auto& block : blocks_)
		{
			if (!block.summary.solid) continue;
			first = std::min(first, component(block.index, axis));
			last = std::max(last, component(block.index, axis));
		}
		if (last < first) return std::nullopt;

		std::vector<TsdfBlock::Slice> slices((last - first + 1) * TsdfBlock::side);
		for (const auto& block : blocks_)
		{
			if (!block.summary.solid) continue;
			const int offset = (component(block.index, axis) - first) * TsdfBlock::side;
			for (int i = 0; i < TsdfBlock::side; ++i)
			{
				slices[offset + i].depthSum += block.summary.slices[axis][i].depthSum;
				slices[offset + i].count += block.summary.slices[axis][i].count;
			}
		}
		const auto range = trimmedRange(slices, first * TsdfBlock::side, options_.voxelSize);
		if (!range) return std::nullopt;
		box.min[axis] = range->first;
		box.max[axis] = range->second;
	}
	return box;
}

std::optional<double> TsdfVolume::distance(const mrpt::math::TPoint3D& p_object) const
{
	// Out of reach of any block; also keeps the integer conversion below in range.
	const double reach = BlockIndex::limit * TsdfBlock::side * options_.voxelSize;
	for (int axis = 0; axis < 3; ++axis)
		if (!(std::abs(p_object[axis]) < reach)) return std::nullopt;

	const Eigen::Vector3d p(p_object.x, p_object.y, p_object.z);
	const Eigen::Vector3f q =
		(p / options_.voxelSize - Eigen::Vector3d::Constant(0.5)).cast<float>();
	const float d = TsdfSampler(blocks_).trilinear(q);
	if (std::isnan(d)) return std::nullopt;
	return d;
}

std::size_t TsdfVolume::memoryBytes() const
{
	return sizeof(*this) + blocks_.memoryBytes();
}

}  // namespace semloop
