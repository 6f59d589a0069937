#pragma once

#include <semloop/simulation/Mesh.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** A rectangle on the floor whose sides may be turned. */
struct Footprint
{
	Eigen::Vector2d center = Eigen::Vector2d::Zero();  //!< [m]
	Eigen::Vector2d size = Eigen::Vector2d::Zero();    //!< along its own axes [m]
	double yaw = 0;                                    //!< [rad]

	std::vector<Eigen::Vector2d> corners() const;
};

/** Whether two come nearer to each other than a clearance [m] (separating axes, so that corners may
 *  be a little nearer than asked). */
bool overlap(const Footprint& a, const Footprint& b, double clearance);

/** Distance of a point to a footprint, 0 inside [m]. */
double distance(const Footprint& footprint, const Eigen::Vector2d& point);

/** A rectangular room; its walls stand outside of it. */
struct Room
{
	std::string name;
	Eigen::Vector2d corner = Eigen::Vector2d::Zero();  //!< the lower left one [m]
	Eigen::Vector2d size = Eigen::Vector2d::Zero();    //!< [m]

	Footprint footprint() const { return {corner + size / 2, size, 0.0}; }
};

/** An opening in every wall that passes through its centre. */
struct Door
{
	Eigen::Vector2d center = Eigen::Vector2d::Zero();  //!< [m]
	double width = 0.9;                                //!< [m]
};

/** One piece of a room's wall, as seen from inside. */
struct Wall
{
	Footprint footprint;
	std::size_t room = 0;
	Eigen::Vector2d inward = Eigen::Vector2d::Zero();  //!< unit length, into the room
	bool aboveDoor = false;                            //!< only above kDoorHeight
};

/** Rooms, walls and doors of a storey. */
class FloorPlan
{
public:
	static constexpr double kWallThickness = 0.1;  //!< [m]
	static constexpr double kDoorHeight = 2.05;    //!< [m]

	/** Throws InputError when rooms overlap or leave no space for a wall, or a door is in no wall. */
	FloorPlan(std::vector<Room> rooms, std::vector<Door> doors, double height);

	const std::vector<Room>& rooms() const { return rooms_; }
	const std::vector<Door>& doors() const { return doors_; }
	const std::vector<Wall>& walls() const { return walls_; }

	/** Whether a person of that radius can stand there: in a room or a door, clear of the walls. */
	bool isFree(const Eigen::Vector2d& point, double radius) const;

	/** Floor, walls and ceiling; the seed chooses their colours and patterns. */
	Mesh mesh(uint64_t seed) const;

private:
	void addWalls(std::size_t room);
	void addWall(std::size_t room, int side);

	std::vector<Room> rooms_;
	std::vector<Door> doors_;
	double height_;
	std::vector<Wall> walls_;
};

}  // namespace semloop
