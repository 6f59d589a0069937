#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace semloop
{
/** Names of the instances by the id that the mesh's vertices have. */
using SceneNnAnnotation = std::map<uint32_t, std::string>;

/** Reads an annotation's <label id="..." text="..."> elements, wherever they stand. Those without text are
 *  segments that nobody named, and left out; other attributes (color, nyu_class, aabbox, ...) are passed
 *  over.
 *
 *  Throws InputError, naming file and line, when it is no XML, or an id is missing, no number or repeated;
 *  and when no label has a text. */
SceneNnAnnotation readSceneNnAnnotation(const std::string& path);

}  // namespace semloop
