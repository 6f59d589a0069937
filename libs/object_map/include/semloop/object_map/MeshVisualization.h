#pragma once

#include <mrpt/opengl/CSetOfTriangles.h>
#include <semloop/object_map/TsdfVolume.h>

namespace semloop
{
/** The mesh with its colours and normals, for MRPT's scenes. */
mrpt::opengl::CSetOfTriangles::Ptr trianglesOf(const TriangleMesh& mesh);

}  // namespace semloop
