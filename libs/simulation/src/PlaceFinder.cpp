#include "PlaceFinder.h"

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
using Eigen::Vector2d;

constexpr double kWallGap = 0.02;   // [m]
constexpr double kDoorDepth = 0.6;  // of the space that stays free before a door [m]
constexpr std::size_t kWayStep =
	2;  // of the way's points; 4 cm cost less than a millimetre of clearance
}  // namespace

PlaceFinder::PlaceFinder(
	const FloorPlan& plan, std::size_t room, const std::vector<Vector2d>& way, double wayClearance,
	double clearance)
	: room_(plan.rooms()[room]), wayClearance_(wayClearance), clearance_(clearance)
{
	keepClear(plan, room_, way);
}

void PlaceFinder::mindCopy(
	const FloorPlan& plan, std::size_t room, const std::vector<Vector2d>& way)
{
	keepClear(plan, plan.rooms()[room], way);
}

void PlaceFinder::keepClear(
	const FloorPlan& plan, const Room& room, const std::vector<Vector2d>& way)
{
	const Vector2d move = room_.corner - room.corner;
	for (std::size_t i = 0; i < way.size(); i += kWayStep)
		if (distance(room.footprint(), way[i]) < wayClearance_) way_.push_back(way[i] + move);
	for (const auto& wall : plan.walls())
	{
		if (!wall.aboveDoor) continue;
		Footprint before = wall.footprint;
		before.size += 2 * kDoorDepth * wall.inward.cwiseAbs();
		before.center += move;
		if (overlap(before, room_.footprint(), 0.0)) keepClear_.push_back(before);
	}
}

bool PlaceFinder::isFree(const Footprint& footprint) const
{
	for (const auto& corner : footprint.corners())
		if (distance(room_.footprint(), corner) > 0) return false;
	const auto meets = [&](const Footprint& other) { return overlap(footprint, other, 0.0); };
	if (std::any_of(keepClear_.begin(), keepClear_.end(), meets)) return false;
	if (std::any_of(
			taken_.begin(), taken_.end(),
			[&](const Footprint& other) { return overlap(footprint, other, clearance_); }))
		return false;
	return std::none_of(
		way_.begin(), way_.end(),
		[&](const Vector2d& place) { return distance(footprint, place) < wayClearance_; });
}

std::optional<Footprint> PlaceFinder::draw(
	const std::string& kind, const Vector2d& size, RandomStream& random) const
{
	// A piece's back is +y: turned by a quarter it stands at the left wall, and so on.
	const auto quarter = int(random.below(4));
	Footprint place;
	place.size = size;
	place.yaw = quarter * M_PI / 2;
	const Vector2d extent = quarter % 2 == 0 ? size : Vector2d(size.y(), size.x());
	const Vector2d free = room_.size - extent - Vector2d(2 * kWallGap, 2 * kWallGap);
	if (free.minCoeff() < 0) return std::nullopt;
	Vector2d share(random.uniform(0, 1), random.uniform(0, 1));
	const int across = quarter % 2 == 0 ? 1 : 0;
	if (kind == "wall" || kind == "corner")
		share[across] = quarter == 0 || quarter == 3 ? 1.0 : 0.0;
	if (kind == "corner") share[1 - across] = std::round(share[1 - across]);
	place.center =
		room_.corner + Vector2d(kWallGap, kWallGap) + extent / 2 + share.cwiseProduct(free);
	if (kind == "floor") place.yaw += random.uniform(-0.2, 0.2);
	if (!isFree(place)) return std::nullopt;
	return place;
}

}  // namespace semloop
