#pragma once

#include <semloop/object_map/TsdfVolume.h>

#include <memory>

namespace semloop
{
/** True when the volume may have refused measurements for lack of blocks. */
bool isFull(const TsdfVolume& volume);

/** The same surface in voxels twice as large, a quarter of the blocks: for an object that turns out
 *  to be much larger than the part that was seen first. */
std::shared_ptr<TsdfVolume> coarsened(const TsdfVolume& volume);

}  // namespace semloop
