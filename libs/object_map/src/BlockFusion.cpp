#include "BlockFusion.h"

#include <algorithm>
#include <cmath>

namespace semloop
{
BlockFusion::BlockFusion(
	const VoxelProjection& projection, const DepthMeasurements& measurements,
	const TsdfOptions& options)
	: projection_(projection),
	  measurements_(measurements),
	  truncation_(static_cast<float>(options.truncation)),
	  maxWeight_(static_cast<float>(options.maxWeight)),
	  behindScale_(static_cast<float>(1 / std::max(options.truncation - options.voxelSize, 1e-6)))
{
	for (int i = 0; i < lanes; ++i)
	{
		const Eigen::Vector2f at(
			static_cast<float>(i % TsdfBlock::side), static_cast<float>(i / TsdfBlock::side));
		const Eigen::Vector3f offset = projection.steps().leftCols<2>() * at;
		offsetU_[i] = offset.x();
		offsetV_[i] = offset.y();
		offsetZ_[i] = offset.z();
	}
	for (int n = 1; n <= maxColorMemory; ++n) reciprocal_[n] = 65536 / n + 1;
}

bool BlockFusion::fuse(TsdfBlock& block) const
{
	constexpr int side = TsdfBlock::side;
	const Eigen::Vector3f first = firstVoxel(block.index);
	const auto bounds = projection_.bounds(first, first.array() + (side - 1));
	if (bounds.zMin < VoxelProjection::nearPlane) return false;
	if (!measurements_.anyBeyond(bounds, bounds.zMin - truncation_)) return false;

	Eigen::Vector3f start = projection_(first.x(), first.y(), first.z());
	bool changed = false;
	for (int z = 0; z < side; ++z)
	{
		changed |= fuseSlice(block, z * lanes, start);
		start += projection_.steps().col(2);
	}
	return changed;
}

bool BlockFusion::fuseSlice(TsdfBlock& block, int first, const Eigen::Vector3f& start) const
{
	Reading reading;
	project(start, reading);
	read(reading);
	if (!anySeen(reading)) return false;
	average(block, first, reading);
	vote(block, first, reading);
	return true;
}

void BlockFusion::project(const Eigen::Vector3f& start, Reading& reading) const
{
	const cv::Rect& region = measurements_.region();
	const float firstU = 1.5F - static_cast<float>(region.x);
	const float firstV = 1.5F - static_cast<float>(region.y);
	const auto limitU = static_cast<float>(region.width + 1);
	const auto limitV = static_cast<float>(region.height + 1);
	const auto stride = static_cast<float>(measurements_.stride());
	const float startU = start.x(), startV = start.y(), startZ = start.z();
	for (int i = 0; i < lanes; ++i)
	{
		const float z = startZ + offsetZ_[i];
		const float inverse = 1 / z;
		const float u = (startU + offsetU_[i]) * inverse + firstU;
		const float v = (startV + offsetV_[i]) * inverse + firstV;
		const auto column = static_cast<int32_t>(std::min(std::max(u, 0.F), limitU));
		const auto row = static_cast<int32_t>(std::min(std::max(v, 0.F), limitV));
		// In float, exactly: baseline x86-64 has no vector product of integers.
		reading.entry[i] = static_cast<int32_t>(static_cast<float>(row) * stride) + column;
		reading.voxelDepth[i] = z;
	}
}

void BlockFusion::read(Reading& reading) const
{
	const Measurement* const measurements = measurements_.data();
	for (int i = 0; i < lanes; ++i)
	{
		reading.depth[i] = measurements[reading.entry[i]].depth;
		reading.weight[i] = measurements[reading.entry[i]].weight;
	}
}

bool BlockFusion::anySeen(const Reading& reading) const
{
	const float truncation = truncation_;
	int32_t any = 0;
	for (int i = 0; i < lanes; ++i)
	{
		const int32_t valid = reading.depth[i] > 0 ? 1 : 0;
		any |= valid & (reading.depth[i] - reading.voxelDepth[i] > -truncation ? 1 : 0);
	}
	return any != 0;
}

void BlockFusion::average(TsdfBlock& block, int first, const Reading& reading) const
{
	float* const distance = &block.distance[first];
	float* const weight = &block.weight[first];
	const float truncation = truncation_, maxWeight = maxWeight_, behindScale = behindScale_;
	for (int i = 0; i < lanes; ++i)
	{
		const float s = reading.depth[i] - reading.voxelDepth[i];
		const int32_t valid = reading.depth[i] > 0 ? 1 : 0, masked = reading.weight[i] > 0 ? 1 : 0;
		const int32_t seen = s > -truncation ? 1 : 0, free = s >= truncation ? 1 : 0;
		const int32_t update = valid & (free | (seen & masked));
		const float behind = std::min((s + truncation) * behindScale, 1.F);
		const float w = static_cast<float>(update) * std::abs(reading.weight[i]) * behind;
		const float sum = weight[i] + w;
		// Exactly 1 at the first measurement, so that what was there before drops out.
		const float share = w / std::max(sum, 1e-30F);
		distance[i] = (1 - share) * distance[i] + share * std::min(s, truncation);
		weight[i] = std::min(sum, maxWeight);
	}
}

void BlockFusion::vote(TsdfBlock& block, int first, const Reading& reading) const
{
	const float truncation = truncation_, halfTruncation = 0.5F * truncation_;
	Slice<int32_t> votes, colored;
	for (int i = 0; i < lanes; ++i)
	{
		const float s = std::abs(reading.depth[i] - reading.voxelDepth[i]);
		const int32_t valid = reading.depth[i] > 0 ? 1 : 0, masked = reading.weight[i] > 0 ? 1 : 0;
		const int32_t inBand = valid & (s < truncation ? 1 : 0);
		votes[i] = inBand * (masked + masked - 1);
		colored[i] = inBand & masked & (s < halfTruncation ? 1 : 0);
	}
	int8_t* const evidence = &block.evidence[first];
	for (int i = 0; i < lanes; ++i)
	{
		const int32_t sum = evidence[i] + votes[i];
		evidence[i] = static_cast<int8_t>(std::min(std::max(sum, -127), 127));
	}
	for (int i = 0; i < lanes; ++i)
		if (colored[i] != 0) blendColor(block, first + i, reading.entry[i]);
}

void BlockFusion::blendColor(TsdfBlock& block, int voxel, int entry) const
{
	const uint8_t* const rgb = measurements_.color(entry);
	if (!rgb) return;
	auto& mean = block.color[voxel];
	const bool none = (mean[0] | mean[1] | mean[2]) == 0;
	const int n = none ? 1 : std::clamp<int>(block.evidence[voxel], 1, maxColorMemory);
	for (int c = 0; c < 3; ++c)
		mean[c] = static_cast<uint8_t>((mean[c] * (n - 1) + rgb[c] + n / 2) * reciprocal_[n] >> 16);
}

}  // namespace semloop
