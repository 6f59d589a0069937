#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace semloop
{
/** Reads the property `label` of the vertices of a PLY file, ASCII or binary little endian, whose first
 *  element they are. Throws InputError, naming the file, when they have no such property, or a label is
 *  not an integer in [0, 2^32). */
std::vector<uint32_t> readVertexLabels(const std::string& path);

}  // namespace semloop
