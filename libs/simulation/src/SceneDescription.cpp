#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/SceneDescription.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

namespace semloop
{
namespace
{
const std::string kRoomPrefix = "room.";

/** The numbers of a text, of which there must be `count`. */
std::vector<double> numbers(const std::string& text, std::size_t count, const std::string& place)
{
	std::istringstream in(text);
	std::vector<double> values;
	for (double value = 0; in >> value;) values.push_back(value);
	if (!in.eof() || values.size() != count)
		throw UsageError(
			place + " = " + text + ": not allowed; use " + std::to_string(count) + " numbers");
	return values;
}

Eigen::Vector2d point(const std::vector<std::string>& list, const std::string& place)
{
	std::string text;
	for (const auto& part : list) text += (text.empty() ? "" : " ") + part;
	const auto values = numbers(text, 2, place);
	return {values[0], values[1]};
}

std::string trimmed(const std::string& text)
{
	const auto first = text.find_first_not_of(' ');
	if (first == std::string::npos) return {};
	return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::map<std::string, ItemOptions> loadItems(const std::string& file)
{
	if (!std::filesystem::is_regular_file(file))
		throw InputError(file + ": no such models file; config_ini/scenes/models.ini is one");
	const mrpt::config::CConfigFile config(file);
	std::map<std::string, ItemOptions> items;
	std::vector<std::string> sections;
	config.getAllSections(sections);
	for (const auto& section : sections)
	{
		if (section.empty()) continue;
		ItemOptions item;
		item.loadFromConfigFile(config, section);
		const std::string place = file + ": [" + section + "] ";
		if (item.label.empty() || item.models.empty())
			throw UsageError(place + ": needs both label and models");
		if (!item.spot.empty() && point(item.spot, place + "spot").cwiseAbs().maxCoeff() > 1)
			throw UsageError(place + "spot: not allowed; use two numbers in [-1, 1]");
		items.emplace(section, item);
	}
	return items;
}
}  // namespace

void SceneOptions::describe(OptionFields& f)
{
	f.text("models", models, "file with the furniture to choose from, beside this one");
	f.list("doors", doors, "`x y width` each [m]: an opening in the walls at that point");
	f.number("height", height, 2.2, 5, "of the rooms [m]");
	f.flag("same_models", sameModels, "one model for all items of a name, as in an office");
	f.number("path_clearance", pathClearance, 0.2, 2, "of furniture from the camera's path [m]");
	f.number("ambient", ambient, 0, 2, "light from everywhere; 1 shows white as white");
	f.number(
		"light_intensity", lightIntensity, 0, 50,
		"of each lamp, at one metre, in the unit of `ambient`; a room has one every 3 m, at least "
		"2");
}

void RoomOptions::describe(OptionFields& f)
{
	f.list("corner", corner, "lower left corner of the floor: x, y [m]");
	f.list("size", size, "along x and y [m]");
	f.list(
		"furniture", furniture,
		"groups `base + on top + ... > around > ...` of sections of the models file");
	f.text("like", like, "furnished like that room, of the same size, piece by piece");
}

void PathOptions::describe(OptionFields& f)
{
	f.list("waypoints", waypoints, "`x y` each [m]; a Catmull-Rom spline goes through them");
	f.flag("closed", closed, "from the last waypoint back to the first");
	f.flag("returns", returns, "then turns round and goes the whole way back");
	f.number("speed", speed, 0.05, 3, "[m/s]");
	f.number("minimum_height", minimumHeight, 0.3, 3, "of the camera above the floor [m]");
	f.number("maximum_height", maximumHeight, 0.3, 3, "[m]");
	f.degrees("pitch_deg", pitch, -80, 80, "of the optical axis, negative: downwards");
	f.degrees("sway_deg", sway, 0, 90, "amplitude of looking to the left and right");
	f.number("sway_period", swayPeriod, 1, 100, "[s]");
	f.number("turn", turn, 1, 60, "duration of turning round [s]");
	f.number("jitter", jitterTranslation, 0, 0.1, "the hand's shaking, sigma [m]");
	f.degrees("jitter_deg", jitterRotation, 0, 10, "the hand's shaking, sigma");
}

void CameraOptions::describe(OptionFields& f)
{
	f.integer("width", width, 16, 4096, "of the images [px]");
	f.integer("height", height, 16, 4096, "[px]");
	f.degrees("field_of_view_deg", fieldOfView, 10, 150, "horizontal");
	f.number("rate", rate, 0.1, 240, "images a second");
}

void ItemOptions::describe(OptionFields& f)
{
	f.text("label", label, "class of the object");
	f.list("models", models, "ids of the furniture catalogue or `primitive:KIND`; one is drawn");
	f.choice("place", place, {"wall", "floor", "corner", "top"}, "where it stands");
	f.list("spot", spot, "of one on top: x, y in [-1, 1] of the free space there; empty: any");
}

SceneDescription SceneDescription::load(
	const mrpt::config::CConfigFileBase& config, const std::vector<std::string>& otherSections)
{
	SceneDescription result;
	const std::string file = result.file = configFileName(config);
	std::vector<std::string> known = otherSections, sections;
	known.insert(known.end(), {"scene", "path", "camera", kRoomPrefix + "NAME"});
	config.getAllSections(sections);
	for (const auto& section : sections)
	{
		if (section.rfind(kRoomPrefix, 0) != 0) continue;
		known.push_back(section);
		RoomOptions room;
		room.loadFromConfigFile(config, section);
		result.rooms.emplace_back(section.substr(kRoomPrefix.size()), room);
	}
	requireKnownSections(config, known);
	if (result.rooms.empty()) throw UsageError(file + ": no [room.NAME]; a scene needs one");
	result.scene.loadFromConfigFile(config, "scene");
	result.path.loadFromConfigFile(config, "path");
	result.camera.loadFromConfigFile(config, "camera");
	result.modelsFile = (std::filesystem::path(file).parent_path() / result.scene.models).string();
	result.items = loadItems(result.modelsFile);
	return result;
}

FloorPlan SceneDescription::floorPlan() const
{
	std::vector<Room> plan;
	for (const auto& [name, room] : rooms)
	{
		const std::string place = file + ": [" + kRoomPrefix + name + "] ";
		plan.push_back(
			{name, point(room.corner, place + "corner"), point(room.size, place + "size")});
		if (plan.back().size.minCoeff() < 0.5)
			throw UsageError(place + "size: not allowed; a room has at least half a metre");
	}
	std::vector<Door> doors;
	for (const auto& text : scene.doors)
	{
		const auto values = numbers(text, 3, file + ": [scene] doors");
		if (values[2] < 0.5)
			throw UsageError(
				file + ": [scene] doors = " + text + ": not allowed; a door is at least 0.5 wide");
		doors.push_back({{values[0], values[1]}, values[2]});
	}
	try
	{
		return FloorPlan(plan, doors, scene.height);
	}
	catch (const InputError& error)
	{
		throw InputError(file + ": " + error.what());
	}
}

std::vector<Eigen::Vector2d> SceneDescription::waypoints() const
{
	const std::string place = file + ": [path] waypoints";
	std::vector<Eigen::Vector2d> points;
	for (const auto& text : path.waypoints)
	{
		const auto values = numbers(text, 2, place);
		points.emplace_back(values[0], values[1]);
	}
	if (points.size() < 2) throw UsageError(place + ": needs at least two points");
	return points;
}

FurnitureGroup SceneDescription::group(const std::string& room, const std::string& text) const
{
	FurnitureGroup group;
	char kind = 0;
	std::size_t begin = 0;
	while (begin <= text.size())
	{
		const std::size_t end = std::min(text.size(), text.find_first_of("+>", begin));
		const std::string name = trimmed(text.substr(begin, end - begin));
		if (items.count(name) == 0)
			throw UsageError(
				file + ": [" + kRoomPrefix + room + "] furniture = " + text + ": '" + name +
				"' is no section of " + modelsFile);
		if (kind == 0)
			group.base = name;
		else
			(kind == '+' ? group.onTop : group.around).push_back(name);
		kind = end < text.size() ? text[end] : '\0';
		begin = end + 1;
	}
	return group;
}

}  // namespace semloop
