#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/bits_math.h>
#include <semloop/config/Options.h>
#include <semloop/simulation/FloorPlan.h>

#include <map>
#include <string>
#include <vector>

namespace semloop
{
/** Section [scene]. */
struct SceneOptions : Options
{
	std::string models = "models.ini";  //!< beside the scene's file
	std::vector<std::string> doors;     //!< "x y width" each [m]
	double height = 2.6;                //!< of the rooms [m]
	bool sameModels = false;            //!< one model for all items of a name
	double pathClearance = 0.35;        //!< of furniture from the path [m]
	double ambient = 0.35;
	double lightIntensity =
		1.4;  //!< of each lamp, at one metre; a room has one every 3 m, at least 2

protected:
	void describe(OptionFields& fields) override;
};

/** Section [room.NAME]. */
struct RoomOptions : Options
{
	std::vector<std::string> corner, size;  //!< x, y [m]
	/** Groups, in the order in which they look for a place; see FurnitureGroup. */
	std::vector<std::string> furniture;
	std::string like;  //!< furnished as that room is, place by place

protected:
	void describe(OptionFields& fields) override;
};

/** Section [path]: how the camera is carried. */
struct PathOptions : Options
{
	std::vector<std::string> waypoints;               //!< "x y" each [m]
	bool closed = false;                              //!< from the last waypoint back to the first
	bool returns = false;                             //!< then turns round and goes the way back
	double speed = 0.4;                               //!< [m/s]
	double minimumHeight = 1.3, maximumHeight = 1.5;  //!< [m]
	double pitch = mrpt::DEG2RAD(-15.0);              //!< below the horizon is negative [rad]
	double sway = mrpt::DEG2RAD(30.0);  //!< amplitude of looking to the left and right [rad]
	double swayPeriod = 8.0;            //!< [s]
	double turn = 5.0;                  //!< duration of turning round [s]
	double jitterTranslation = 0.006;   //!< sigma of the hand's shaking [m]
	double jitterRotation = mrpt::DEG2RAD(0.6);  //!< [rad]

protected:
	void describe(OptionFields& fields) override;
};

/** Section [camera]. */
struct CameraOptions : Options
{
	int width = 640, height = 480;           //!< [px]
	double fieldOfView = mrpt::DEG2RAD(62);  //!< horizontal [rad]
	double rate = 30.0;                      //!< [Hz]

protected:
	void describe(OptionFields& fields) override;
};

/** A section of models.ini: a kind of thing that stands in a room. */
struct ItemOptions : Options
{
	std::string label;
	std::vector<std::string> models;  //!< catalogue ids or primitive:KIND; one is drawn
	std::string place = "floor";      //!< wall, floor, corner or top
	std::vector<std::string>
		spot;  //!< of one on top: x, y in [-1, 1] of the room there; empty: any

protected:
	void describe(OptionFields& fields) override;
};

/** "desk + monitor + keyboard > chair": something that stands in the room, what stands on top of it,
 *  and what stands around it, facing it. */
struct FurnitureGroup
{
	std::string base;
	std::vector<std::string> onTop;
	std::vector<std::string> around;
};

/** A scene's ini file. */
struct SceneDescription
{
	std::string file;
	std::string modelsFile;  //!< its path
	SceneOptions scene;
	std::vector<std::pair<std::string, RoomOptions>> rooms;  //!< by name
	PathOptions path;
	CameraOptions camera;
	std::map<std::string, ItemOptions> items;  //!< of models.ini, by name

	/** Reads a scene and the models file that it names. Sections that belong to others (the sensors)
	 *  are given by name. Throws UsageError, naming file, section and key, on what cannot be
	 *  understood. */
	static SceneDescription load(
		const mrpt::config::CConfigFileBase& config, const std::vector<std::string>& otherSections);

	FloorPlan floorPlan() const;
	std::vector<Eigen::Vector2d> waypoints() const;
	FurnitureGroup group(const std::string& room, const std::string& text) const;
};

}  // namespace semloop
