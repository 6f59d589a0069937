#pragma once

#include <semloop/simulation/Mesh.h>

#include <string>
#include <vector>

#include "ZipArchive.h"

namespace semloop
{
/** An OBJ model with its MTL materials, in the OBJ's own frame and unit. */
struct ObjModel
{
	Mesh mesh;                              //!< its textures are not read yet
	std::vector<float> opacity;             //!< of each material, in [0, 1]; MTL's d or 1 - Tr
	std::vector<std::string> texturePaths;  //!< of each of the mesh's textures, in the archive
};

/** All shapes of an OBJ file as one mesh of triangles. Triangles without area or with indices out of
 *  range are dropped; what has no material is grey. Throws InputError, naming archive and model, when
 *  it is not there, is not an OBJ file or has no triangle. */
ObjModel readObj(const ZipArchive& archive, const std::string& path);

}  // namespace semloop
