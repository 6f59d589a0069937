#pragma once

#include <semloop/simulation/FloorPlan.h>

#include <optional>
#include <string>
#include <vector>

#include "Random.h"

namespace semloop
{
/** Free places on the floor of a room. */
class PlaceFinder
{
public:
	/** Keeps clear of doors, of the way by wayClearance and of other pieces by clearance [m]. */
	PlaceFinder(
		const FloorPlan& plan, std::size_t room, const std::vector<Eigen::Vector2d>& way,
		double wayClearance, double clearance);

	/** Keeps clear, too, of the doors and the way of a room that gets the same furniture. */
	void mindCopy(const FloorPlan& plan, std::size_t room, const std::vector<Eigen::Vector2d>& way);

	/** One try: a place at a "wall" (the piece's back to it), in a "corner", or anywhere on the "floor";
	 *  empty when that is not free. */
	std::optional<Footprint> draw(
		const std::string& kind, const Eigen::Vector2d& size, RandomStream& random) const;

	bool isFree(const Footprint& footprint) const;
	void occupy(const Footprint& footprint) { taken_.push_back(footprint); }

private:
	/** What must stay clear in `room`, moved to room_. */
	void keepClear(
		const FloorPlan& plan, const Room& room, const std::vector<Eigen::Vector2d>& way);

	Room room_;
	std::vector<Eigen::Vector2d> way_;  // near the room, thinned out
	double wayClearance_, clearance_;
	std::vector<Footprint> keepClear_;  // before doors
	std::vector<Footprint> taken_;
};

}  // namespace semloop
