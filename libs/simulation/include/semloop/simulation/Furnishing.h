#pragma once

#include <semloop/simulation/FloorPlan.h>
#include <semloop/simulation/FurnitureModels.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneDescription.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace semloop
{
/** Puts the description's furniture into the rooms: on the floor, at walls, in corners, on top of each
 *  other, never inside one another, clear of doors and of the way. Each group tries places at random
 *  and takes the first that is free; the seed chooses places and models.
 *
 *  Objects come in the order of the rooms and their lists. Throws InputError, naming room, group and
 *  size, when a group finds no place. */
std::vector<SceneObject> furnish(
	const SceneDescription& description, const FloorPlan& plan,
	const std::vector<Eigen::Vector2d>& way, FurnitureModels& models, const LabelSet& labels,
	uint64_t seed);

}  // namespace semloop
