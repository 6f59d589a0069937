#pragma once

#include <semloop/simulation/Mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace semloop
{
/** Things that the catalogue does not have or has too few of, with drawn textures, in furniture's frame
 *  and of usual size: "book" (lying), "box" (cardboard), "keyboard" (its user at -y), "monitor",
 *  "mouse", "picture" (framed, upright). The seed chooses colours, what is printed on them, and the size:
 *  within 3 % of the usual one, books, boxes and pictures more freely. The same seed gives the same mesh.
 *  Throws InputError, listing the kinds, for another. */
Mesh makePrimitive(const std::string& kind, uint64_t seed);

/** Throws InputError, listing the kinds, when this is none. */
void requirePrimitive(const std::string& kind);

/** The kinds above, sorted. */
std::vector<std::string> primitiveKinds();

}  // namespace semloop
