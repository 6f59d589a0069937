#pragma once

#include <semloop/object_map/CObjectMap.h>

#include <string>

namespace semloop
{
/** Throws InputError when the file cannot be written. gz-compressed MRPT serialisation. */
void saveObjectMap(const std::string& path, const CObjectMap& map);
/** Throws InputError on a missing, cut or foreign file. */
CObjectMap::Ptr loadObjectMap(const std::string& path);

/** Name of an object's mesh file, `<id>_<label>.ply`; - where the label has anything but letters and
 *  digits. */
std::string objectFileName(ObjectId id, std::string label);

/** The folder `<prefix>_objects` for the meshes of a map's objects: is made, and what a map before left
 *  under such names is removed. Other files in it stay. Throws InputError when it cannot be made. */
std::string makeObjectsFolder(const std::string& prefix);

/** Binary PLY of a mesh in world coordinates, with normals and colours. */
void savePly(const std::string& path, const TriangleMesh& mesh, const mrpt::poses::CPose3D& T_world_object);

}  // namespace semloop
