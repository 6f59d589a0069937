#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "TsdfProjection.h"
#include "TsdfSampler.h"

namespace semloop
{
namespace
{
/** A volume between its voxels. */
struct ResampledVoxel
{
	float known = 0;  //!< share of the 8 neighbours, by trilinear weight
	float distance = 0, weight = 0, evidence = 0;
	Eigen::Vector3f color = Eigen::Vector3f::Zero();
};

ResampledVoxel resample(TsdfSampler& sampler, const Eigen::Vector3f& q)
{
	ResampledVoxel result;
	sampler.forNeighbours(
		q,
		[&](const TsdfSampler::Voxel& v, float w)
		{
			const auto& color = v.block->color[v.voxel];
			result.known += w;
			result.distance += w * v.block->distance[v.voxel];
			result.weight += w * v.block->weight[v.voxel];
			result.evidence += w * static_cast<float>(v.block->evidence[v.voxel]);
			result.color += w * Eigen::Vector3f(color[0], color[1], color[2]);
		});
	if (result.known > 0)
	{
		const float scale = 1 / result.known;
		result.distance *= scale, result.weight *= scale, result.evidence *= scale;
		result.color *= scale;
	}
	return result;
}

using Place = std::tuple<int32_t, int32_t, int32_t>;  // ordered by z, y, x

/** Blocks of this volume that a block of the other one may touch. */
void coveredPlaces(
	const TsdfBlock& block, const RigidTransform& T_this_other, float otherVoxel, float thisVoxel,
	std::set<Place>& places)
{
	const Eigen::Vector3f first = firstVoxel(block.index) * otherVoxel;
	Eigen::Array3f low = Eigen::Array3f::Constant(1e9F), high = -low;
	for (int corner = 0; corner < 8; ++corner)
	{
		const Eigen::Vector3f offset(corner & 1, corner >> 1 & 1, corner >> 2);
		const Eigen::Vector3f p =
			T_this_other.rotation * (first + offset * (TsdfBlock::side * otherVoxel)) +
			T_this_other.translation;
		low = low.min(p.array());
		high = high.max(p.array());
	}
	constexpr auto limit = static_cast<float>(BlockIndex::limit);
	const float inverse = 1 / (thisVoxel * TsdfBlock::side);
	const Eigen::Array3f from = (low * inverse).floor(), to = (high * inverse - 1e-4F).floor();
	if (!(from >= -limit).all() || !(to < limit).all()) return;
	const Eigen::Array3i a = from.cast<int>(), b = to.cast<int>();
	for (int z = a.z(); z <= b.z(); ++z)
		for (int y = a.y(); y <= b.y(); ++y)
			for (int x = a.x(); x <= b.x(); ++x) places.emplace(z, y, x);
}

/** Weighted mean of both; sums of weight and evidence. */
void fuseVoxel(
	TsdfBlock& block, int v, const ResampledVoxel& other, float distance,
	const TsdfOptions& options)
{
	const float sum = block.weight[v] + other.weight;
	if (sum <= 0) return;
	block.distance[v] = (block.weight[v] * block.distance[v] + other.weight * distance) / sum;
	block.weight[v] = std::min(sum, static_cast<float>(options.maxWeight));

	const float mine = std::max(static_cast<float>(block.evidence[v]), 0.F);
	const float theirs = std::max(other.evidence, 0.F);
	const float share = mine + theirs > 0 ? theirs / (mine + theirs) : 0.F;
	for (int c = 0; c < 3; ++c)
	{
		const auto color = static_cast<float>(block.color[v][c]);
		block.color[v][c] =
			static_cast<uint8_t>(std::lround(color + share * (other.color[c] - color)));
	}
	const float evidence = static_cast<float>(block.evidence[v]) + other.evidence;
	block.evidence[v] = static_cast<int8_t>(std::lround(std::clamp(evidence, -127.F, 127.F)));
}

}  // namespace

void TsdfVolume::merge(const TsdfVolume& other, const mrpt::poses::CPose3D& T_this_other)
{
	if (&other == this)
	{
		merge(TsdfVolume(other), T_this_other);
		return;
	}
	const auto thisVoxel = static_cast<float>(options_.voxelSize);
	const auto otherVoxel = static_cast<float>(other.options_.voxelSize);
	const auto truncation = static_cast<float>(options_.truncation);
	const auto otherFree = static_cast<float>(0.999 * other.options_.truncation);

	makeRoom();
	std::set<Place> places;
	for (const auto& block : other.blocks_)
		coveredPlaces(block, RigidTransform(T_this_other), otherVoxel, thisVoxel, places);

	const RigidTransform T_other_this(-T_this_other);
	const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.5F);
	TsdfSampler sampler(other.blocks_);
	std::array<ResampledVoxel, TsdfBlock::voxels> sampled;
	for (const auto& [z, y, x] : places)
	{
		const BlockIndex index{x, y, z};
		const Eigen::Vector3f first = firstVoxel(index);
		bool nearSurface = false;
		for (int v = 0; v < TsdfBlock::voxels; ++v)
		{
			const Eigen::Vector3f local(
				static_cast<float>(v % 8), static_cast<float>(v / 8 % 8),
				static_cast<float>(v / 64));
			const Eigen::Vector3f p_this = (first + local + half) * thisVoxel;
			const Eigen::Vector3f p_other =
				T_other_this.rotation * p_this + T_other_this.translation;
			sampled[v] = resample(sampler, p_other / otherVoxel - half);
			nearSurface |= sampled[v].known >= 0.5F && sampled[v].distance < otherFree;
		}
		auto* const block = nearSurface ? allocate(index) : blocks_.find(index);
		if (!block) continue;
		for (int v = 0; v < TsdfBlock::voxels; ++v)
		{
			if (sampled[v].known < 0.5F) continue;
			// Free space of the other volume is free here, however far its truncation reaches.
			const float d = sampled[v].distance >= otherFree ? truncation : sampled[v].distance;
			fuseVoxel(*block, v, sampled[v], std::clamp(d, -truncation, truncation), options_);
		}
		summarize(*block);
	}
}

}  // namespace semloop
