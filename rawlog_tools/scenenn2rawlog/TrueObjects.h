#pragma once

#include <string>
#include <vector>

#include "AnnotatedMesh.h"

namespace semloop
{
/** PREFIX_objects.json (semloop.graph/1: the box of each object along the world's axes) and
 *  PREFIX_objects/<id>_<label>.ply, the triangles all of whose corners belong to the object.
 *  `observations`: number of frames that show each object. Throws InputError naming the file that cannot
 *  be written. */
void writeTrueObjects(
	const std::string& prefix, const AnnotatedMesh& mesh, const std::vector<int>& observations);

}  // namespace semloop
