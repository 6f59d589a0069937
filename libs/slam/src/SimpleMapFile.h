#pragma once

#include <semloop/slam/SemanticSlam.h>

#include <string>

namespace semloop
{
/** The key frames as a mrpt::maps::CSimpleMap: robot poses and observations, for observations2map and
 *  friends. They are made and written one by one, for all of them with points and images need many times
 *  the memory of the run.
 *  @throw InputError when the file cannot be written or an external image cannot be read; no file is left. */
void saveSimpleMap(const std::string& path, const SemanticSlam& slam);

}  // namespace semloop
