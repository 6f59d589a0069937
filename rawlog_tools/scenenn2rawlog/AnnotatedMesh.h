#pragma once

#include <semloop/evaluation/PlyFile.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "SceneNnAnnotation.h"

namespace semloop
{
/** An instance of the annotation that the mesh shows. */
struct AnnotatedObject
{
	uint32_t id = 0;  //!< of the annotation
	std::string name;
};

/** A reconstruction whose vertices say which object they belong to. */
struct AnnotatedMesh
{
	static constexpr int kNone = -1;

	Surface surface;                       //!< in the world, z up
	std::vector<AnnotatedObject> objects;  //!< by id
	std::vector<int> objectOfVertex;       //!< index in objects, or kNone
	std::size_t missing = 0;               //!< objects of the annotation that no vertex belongs to
};

/** Reads the mesh and looks its labels up. Throws InputError, naming the file, when the mesh cannot be
 *  read, has no vertices or labels, or a vertex is not finite, and when no object of the annotation is in
 *  it. */
AnnotatedMesh readAnnotatedMesh(
	const std::string& meshPath, const SceneNnAnnotation& annotation,
	const std::string& annotationPath);

}  // namespace semloop
