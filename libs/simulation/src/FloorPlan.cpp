#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/FloorPlan.h>

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
using Eigen::Vector2d;

Vector2d direction(double yaw)
{
	return {std::cos(yaw), std::sin(yaw)};
}

/** Extent of the corners along an axis. */
std::pair<double, double> project(const std::vector<Vector2d>& corners, const Vector2d& axis)
{
	double low = corners.front().dot(axis), high = low;
	for (const auto& corner : corners)
	{
		low = std::min(low, corner.dot(axis));
		high = std::max(high, corner.dot(axis));
	}
	return {low, high};
}

bool separated(const Footprint& a, const Footprint& b, const Vector2d& axis, double clearance)
{
	const auto [lowA, highA] = project(a.corners(), axis);
	const auto [lowB, highB] = project(b.corners(), axis);
	return lowA > highB + clearance || lowB > highA + clearance;
}

void requireApart(const std::vector<Room>& rooms)
{
	for (std::size_t i = 0; i < rooms.size(); ++i)
		for (std::size_t j = 0; j < i; ++j)
			if (overlap(
					rooms[i].footprint(), rooms[j].footprint(), FloorPlan::kWallThickness - 1e-6))
				throw InputError(mrpt::format(
					"rooms '%s' and '%s' overlap, or leave less than %g m for the wall between "
					"them; change corner or size of one",
					rooms[j].name.c_str(), rooms[i].name.c_str(), FloorPlan::kWallThickness));
}
}  // namespace

std::vector<Vector2d> Footprint::corners() const
{
	const Vector2d right = direction(yaw) * size.x() / 2;
	const Vector2d back = direction(yaw + M_PI / 2) * size.y() / 2;
	return {
		center - right - back, center + right - back, center + right + back, center - right + back};
}

bool overlap(const Footprint& a, const Footprint& b, double clearance)
{
	for (const double yaw : {a.yaw, a.yaw + M_PI / 2, b.yaw, b.yaw + M_PI / 2})
		if (separated(a, b, direction(yaw), clearance)) return false;
	return true;
}

double distance(const Footprint& footprint, const Vector2d& point)
{
	const Vector2d offset = point - footprint.center;
	const double x = std::abs(offset.dot(direction(footprint.yaw))) - footprint.size.x() / 2;
	const double y =
		std::abs(offset.dot(direction(footprint.yaw + M_PI / 2))) - footprint.size.y() / 2;
	return std::hypot(std::max(0.0, x), std::max(0.0, y));
}

FloorPlan::FloorPlan(std::vector<Room> rooms, std::vector<Door> doors, double height)
	: rooms_(std::move(rooms)), doors_(std::move(doors)), height_(height)
{
	requireApart(rooms_);
	for (std::size_t room = 0; room < rooms_.size(); ++room) addWalls(room);
	for (const auto& door : doors_)
		if (std::none_of(
				walls_.begin(), walls_.end(),
				[&](const Wall& wall) {
					return wall.aboveDoor &&
						   (wall.footprint.center - door.center).norm() < 2 * kWallThickness;
				}))
			throw InputError(mrpt::format(
				"the door at (%g, %g) is in no wall, or too near to a corner; a door is given by a "
				"point on a wall",
				door.center.x(), door.center.y()));
}

void FloorPlan::addWalls(std::size_t room)
{
	for (int side = 0; side < 4; ++side) addWall(room, side);
}

void FloorPlan::addWall(std::size_t index, int side)
{
	const Room& room = rooms_[index];
	const double t = kWallThickness;
	// Along u, which is x in front and at the back and y at the left and the right.
	const int u = side < 2 ? 0 : 1, v = 1 - u;
	const bool low = side % 2 == 0;
	const double line = low ? room.corner[v] - t / 2 : room.corner[v] + room.size[v] + t / 2;
	const auto add = [&](double from, double to, bool aboveDoor)
	{
		Wall wall;
		wall.footprint.center[u] = (from + to) / 2;
		wall.footprint.center[v] = line;
		wall.footprint.size[u] = to - from;
		wall.footprint.size[v] = t;
		wall.room = index;
		wall.inward[v] = low ? 1 : -1;
		wall.aboveDoor = aboveDoor;
		walls_.push_back(wall);
	};
	auto doors = doors_;
	std::sort(
		doors.begin(), doors.end(),
		[&](const Door& a, const Door& b) { return a.center[u] < b.center[u]; });
	double from = room.corner[u] - t;
	const double end = room.corner[u] + room.size[u] + t;
	for (const auto& door : doors)
	{
		const double begin = door.center[u] - door.width / 2;
		if (std::abs(door.center[v] - line) > 1.5 * t || begin <= from || begin + door.width >= end)
			continue;
		add(from, begin, false);
		from = begin + door.width;
		add(begin, from, true);
	}
	add(from, end, false);
}

bool FloorPlan::isFree(const Vector2d& point, double radius) const
{
	bool somewhere = std::any_of(
		rooms_.begin(), rooms_.end(),
		[&](const Room& room) { return distance(room.footprint(), point) == 0; });
	for (const auto& wall : walls_)
	{
		const double away = distance(wall.footprint, point);
		if (wall.aboveDoor)
			somewhere = somewhere || away == 0;
		else if (away < radius)
			return false;
	}
	return somewhere;
}

}  // namespace semloop
