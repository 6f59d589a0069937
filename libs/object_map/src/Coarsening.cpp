#include "Coarsening.h"

namespace semloop
{
bool isFull(const TsdfVolume& volume)
{
	return volume.blockCount() >= std::size_t(volume.options().maxBlocks);
}

std::shared_ptr<TsdfVolume> coarsened(const TsdfVolume& volume)
{
	TsdfOptions options = volume.options();
	options.voxelSize *= 2;
	options.truncation *= 2;
	auto result = std::make_shared<TsdfVolume>(options);
	result->merge(volume, mrpt::poses::CPose3D());
	return result;
}

}  // namespace semloop
