#pragma once

#include <semloop/simulation/Mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace semloop
{
/** Things that the catalogue does not have, made of boxes with drawn textures, in furniture's frame and
 *  of usual size: "book", "keyboard", "monitor", "mouse", ...  The seed chooses colours, size within a
 *  few per cent, and what is printed on them. Throws InputError, listing the kinds, for another. */
Mesh makePrimitive(const std::string& kind, uint64_t seed);

std::vector<std::string> primitiveKinds();

}  // namespace semloop
