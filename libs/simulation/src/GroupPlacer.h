#pragma once

#include <semloop/simulation/FloorPlan.h>
#include <semloop/simulation/FurnitureModels.h>
#include <semloop/simulation/SceneDescription.h>

#include <optional>
#include <string>
#include <vector>

#include "PlaceFinder.h"
#include "Random.h"

namespace semloop
{
constexpr double kFurnitureGap = 0.04;  //!< between pieces on the floor [m]

/** A piece of furniture in its place. */
struct Placed
{
	const FurnitureModel* model = nullptr;
	std::string item;
	Footprint footprint;
	double z = 0;  //!< of its bottom [m]
	bool onFloor = true;
};

/** A group's pieces, the base first. */
using PlacedGroup = std::vector<Placed>;

/** Draws models and places for the pieces of a group. */
class GroupPlacer
{
public:
	GroupPlacer(const SceneDescription& description, FurnitureModels& models, uint64_t seed);

	/** The first of many tries that succeeds. `place` is named in errors. Throws UsageError for a group
	 *  that can stand nowhere: a base that belongs on top, or one on which nothing can stand. */
	std::optional<PlacedGroup> place(
		const FurnitureGroup& group, const PlaceFinder& finder, const std::string& place);

	/** What hindered the try that came furthest, after place() has failed. */
	const std::string& hindrance() const { return hindrance_; }

private:
	std::optional<PlacedGroup> tryOnce(const FurnitureGroup& group, const PlaceFinder& finder);
	const FurnitureModel& drawModel(const std::string& item);
	bool putOnTop(const std::string& item, const Placed& base, PlacedGroup& group);
	bool putAround(
		const std::string& item, std::size_t index, const Placed& base, const PlaceFinder& finder,
		PlacedGroup& group);

	const SceneDescription& description_;
	FurnitureModels& models_;
	uint64_t seed_;
	RandomStream random_;
	std::string place_, hindrance_;
};

}  // namespace semloop
