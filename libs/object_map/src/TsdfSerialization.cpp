#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace semloop
{
namespace
{
TsdfVolume emptyVolume(const TsdfOptions& options)
{
	try
	{
		return TsdfVolume(options);
	}
	catch (const UsageError&)
	{
		throw InputError("TSDF volume: impossible options; the file is damaged");
	}
}

void writeBlock(mrpt::serialization::CArchive& out, const TsdfBlock& block)
{
	std::array<uint8_t, TsdfBlock::voxels / 8> used{};
	std::vector<float> distances, weights;
	std::vector<uint8_t> bytes;
	for (int v = 0; v < TsdfBlock::voxels; ++v)
	{
		if (block.weight[v] == 0 && block.evidence[v] == 0) continue;
		used[v / 8] |= static_cast<uint8_t>(1 << v % 8);
		distances.push_back(block.weight[v] > 0 ? block.distance[v] : 0.F);
		weights.push_back(block.weight[v]);
		bytes.insert(bytes.end(), block.color[v].begin(), block.color[v].end());
		bytes.push_back(static_cast<uint8_t>(block.evidence[v]));
	}
	for (const int32_t a : {block.index.x, block.index.y, block.index.z})
		out << static_cast<int16_t>(a);
	out.WriteBuffer(used.data(), used.size());
	if (distances.empty()) return;  // a gz stream takes writing nothing for an error
	out.WriteBufferFixEndianness(distances.data(), distances.size());
	out.WriteBufferFixEndianness(weights.data(), weights.size());
	out.WriteBuffer(bytes.data(), bytes.size());
}

BlockIndex readIndex(mrpt::serialization::CArchive& in)
{
	std::array<int16_t, 3> at{};
	for (auto& a : at) in >> a;
	const BlockIndex index{at[0], at[1], at[2]};
	if (!index.valid()) throw InputError("TSDF volume: a block out of range; the file is damaged");
	return index;
}

/** What follows the block's index. */
void readVoxels(mrpt::serialization::CArchive& in, TsdfBlock& block, const TsdfOptions& options)
{
	std::array<uint8_t, TsdfBlock::voxels / 8> used{};
	in.ReadBuffer(used.data(), used.size());
	std::vector<int> voxels;
	for (int v = 0; v < TsdfBlock::voxels; ++v)
		if (used[v / 8] >> v % 8 & 1) voxels.push_back(v);

	const std::size_t n = voxels.size();
	std::vector<float> distances(n), weights(n);
	std::vector<uint8_t> bytes(4 * n);
	if (n > 0)
	{
		in.ReadBufferFixEndianness(distances.data(), n);
		in.ReadBufferFixEndianness(weights.data(), n);
		in.ReadBuffer(bytes.data(), bytes.size());
	}
	for (std::size_t i = 0; i < n; ++i)
	{
		const bool good = std::abs(distances[i]) <= options.truncation * 1.001 && weights[i] >= 0 &&
						  weights[i] <= options.maxWeight * 1.001;  // false for NaN
		if (!good) throw InputError("TSDF volume: impossible voxel values; the file is damaged");
		const int v = voxels[i];
		if (weights[i] > 0) block.distance[v] = distances[i];
		block.weight[v] = weights[i];
		std::copy_n(&bytes[4 * i], 3, block.color[v].begin());
		block.evidence[v] = static_cast<int8_t>(bytes[4 * i + 3]);
	}
}

}  // namespace

void TsdfVolume::serializeTo(mrpt::serialization::CArchive& out) const
{
	out << uint8_t{0} << options_.voxelSize << options_.truncation << options_.maxWeight
		<< static_cast<int32_t>(options_.maxBlocks) << static_cast<uint32_t>(blocks_.size());
	for (const auto& block : blocks_) writeBlock(out, block);
}

void TsdfVolume::serializeFrom(mrpt::serialization::CArchive& in)
{
	uint8_t version = 0;
	in >> version;
	if (version != 0)
		throw InputError(
			"TSDF volume: version " + std::to_string(version) + " is not known; update semloop");

	TsdfOptions options;
	int32_t maxBlocks = 0;
	uint32_t count = 0;
	in >> options.voxelSize >> options.truncation >> options.maxWeight >> maxBlocks >> count;
	options.maxBlocks = maxBlocks;
	TsdfVolume read = emptyVolume(options);
	if (count > static_cast<uint32_t>(maxBlocks))
		throw InputError("TSDF volume: more blocks than allowed; the file is damaged");
	for (uint32_t i = 0; i < count; ++i)
	{
		const BlockIndex index = readIndex(in);
		if (read.blocks_.find(index))
			throw InputError("TSDF volume: a block comes twice; the file is damaged");
		auto& block = read.blocks_.findOrAdd(index);
		readVoxels(in, block, options);
		read.summarize(block);
	}
	*this = std::move(read);
}

}  // namespace semloop
