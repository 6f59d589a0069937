#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/object_map/SemanticGraph.h>

#include <string>
#include <vector>

namespace semloop
{
/** Reads a graph from a semloop.graph/1 file, or that of all objects of a map from an .objmap. Throws
 *  InputError naming file and place. */
SemanticGraph readGraph(const std::string& path);

/** The rigid motion of a 4x4 matrix, row by row; `what` names it in the InputError that is thrown when it is
 *  none. */
mrpt::poses::CPose3D poseFromMatrix(const std::vector<double>& rowMajor, const std::string& what);

std::vector<double> matrixFromPose(const mrpt::poses::CPose3D& pose);

}  // namespace semloop
