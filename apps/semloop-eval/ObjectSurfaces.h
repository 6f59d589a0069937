#pragma once

#include <semloop/evaluation/ObjectEvaluation.h>
#include <semloop/evaluation/SurfaceError.h>

#include <cstddef>
#include <string>

namespace semloop
{
/** Surface error over all matched objects together. */
struct SurfaceReport
{
	std::size_t objects = 0;  //!< matched ones with a mesh on both sides
	SurfaceError error;       //!< over the vertices of these
	std::string note;         //!< why objects are missing; empty when none is
};

/** Compares OUT/objects/<id>_*.ply with <truth without .json>/<id>_*.ply of the matched objects. A mesh
 *  that is not there is noted; one that cannot be read throws InputError. */
SurfaceReport compareSurfaces(
	const std::string& runFolder, const std::string& truthFile, const ObjectEvaluation& objects,
	const mrpt::poses::CPose3D& T_truth_estimate);

}  // namespace semloop
