#pragma once

#include <semloop/simulation/FurnitureCatalog.h>
#include <semloop/simulation/Scene.h>

#include <map>
#include <string>

namespace semloop
{
/** PREFIX_objects.json (semloop.graph/1, doc/file-formats.md) and PREFIX_objects/<id>_<label>.ply, the
 *  mesh of each object in the world. `observations`: number of frames that show each object.
 *  Throws InputError naming the file that cannot be written. */
void writeTrueObjects(
	const std::string& prefix, const Scene& scene, const std::map<uint32_t, int>& observations);

/** Who made each model that the scene uses, and under which licence. */
void writeAttribution(
	const std::string& path, const Scene& scene, const FurnitureCatalog& catalog);

}  // namespace semloop
