#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace semloop
{
/** Points and the triangles between them. */
struct Surface
{
	std::vector<Eigen::Vector3d> vertices;  //!< [m]
	std::vector<std::array<uint32_t, 3>> triangles;
	std::vector<double> labels{};  //!< of the vertices; empty when they have no property `label`
};

/** Reads x, y, z and label of the vertices and the faces, cut into triangles, of a PLY file, ASCII or
 *  binary little endian; passes over everything else. A file without faces is a point cloud. Throws InputError, naming
 *  the file, when it is missing, cut, no such file, or a face names a vertex that is not there. */
Surface readPly(const std::string& path);

}  // namespace semloop
