#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/T3DPointsTo2DScanParams.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/slam/OtherMaps.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;

const std::string kSection = "semloop_map";
const std::string kCount = "_count";

const auto& registeredMaps()
{
	return mrpt::maps::internal::TMetricMapTypesRegistry::Instance().getAllRegistered();
}

bool endsWith(const std::string& text, const std::string& end)
{
	return text.size() >= end.size() &&
		   text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string listOfMaps()
{
	std::string list;
	for (const auto& [name, makers] : registeredMaps())
		if (name.find("::") == std::string::npos) list += (list.empty() ? "" : ", ") + name;
	return list;
}

/** The maps that [semloop_map] counts. */
std::vector<std::string> countedMaps(const mrpt::config::CConfigFileBase& config)
{
	std::vector<std::string> keys;
	config.getAllKeys(kSection, keys);
	std::vector<std::string> maps;
	for (const auto& key : keys)
	{
		if (!endsWith(key, kCount)) continue;
		maps.push_back(key.substr(0, key.size() - kCount.size()));
		if (!registeredMaps().count(maps.back()))
			throw UsageError(
				configFileName(config) + ": [" + kSection + "] " + key + ": no map '" +
				maps.back() + "'; use one of " + listOfMaps() +
				", or load its library with [modules] plugins");
	}
	return maps;
}

std::string nameOf(const std::string& map, int index)
{
	char number[16];
	std::snprintf(number, sizeof(number), "_%02d", index);
	return map + number;
}

void requireSectionsOf(
	const std::vector<std::string>& names, const mrpt::config::CConfigFileBase& config)
{
	for (const auto& section : otherMapsSections(config))
		if (std::none_of(
				names.begin(), names.end(),
				[&](const std::string& name)
				{ return section.rfind(kSection + "_" + name + "_", 0) == 0; }))
			throw UsageError(
				configFileName(config) + ": [" + section + "]: there is no such map; [" + kSection +
				"] <map>_count says how many, from _00 on");
}

/** MRPT looks at the values only when it makes the map. */
void requireMakeable(
	const mrpt::maps::TMetricMapInitializer::Ptr& definition, const std::string& place)
try
{
	mrpt::maps::TSetOfMetricMapInitializers one;
	one.push_back(definition);
	mrpt::maps::CMultiMetricMap map;
	map.setListOfMaps(one);
}
catch (const std::exception& e)
{
	throw UsageError(place + ": the map cannot be made of its options: " + exceptionMessage(e));
}

/** With points, without what is too far to trust. */
CObservation3DRangeScan::Ptr scanWithPoints(
	const CObservation3DRangeScan& original, double maxDepth)
{
	const auto scan = CObservation3DRangeScan::Create(original);
	scan->load();
	const double limit = maxDepth / scan->rangeUnits;
	for (int v = 0; v < scan->rangeImage.rows(); ++v)
		for (int u = 0; u < scan->rangeImage.cols(); ++u)
			if (scan->rangeImage(v, u) > limit) scan->rangeImage(v, u) = 0;
	mrpt::obs::T3DPointsProjectionParams sensorFrame;
	sensorFrame.takeIntoAccountSensorPoseOnRobot = false;
	scan->unprojectInto(*scan, sensorFrame);
	return scan;
}

/** Where a robot would stand that holds this sensor level. */
CPose3D levelled(const CPose3D& T_world_sensor)
{
	const auto& m = T_world_sensor.getRotationMatrix();
	return CPose3D(
		T_world_sensor.x(), T_world_sensor.y(), T_world_sensor.z(), std::atan2(m(1, 0), m(0, 0)), 0,
		0);
}

CObservation2DRangeScan horizontalScan(
	const CObservation3DRangeScan& scan, const CPose3D& T_level_sensor,
	const OtherMapsOptions& options)
{
	CObservation3DRangeScan onLevelRobot = scan;
	onLevelRobot.sensorPose = T_level_sensor;
	mrpt::obs::T3DPointsTo2DScanParams params;
	params.sensorLabel = scan.sensorLabel;
	params.use_origin_sensor_pose = true;
	params.z_min = -options.scanBelow;
	params.z_max = options.scanAbove;
	CObservation2DRangeScan result;
	onLevelRobot.convertTo2DScan(result, params);
	return result;
}

[[noreturn]] void cannotWrite(const fs::path& path)
{
	throw InputError(path.string() + ": cannot be written; is the disk full?");
}

void saveWhole(const fs::path& path, const mrpt::maps::CMetricMap& map)
{
	mrpt::io::CFileGZOutputStream file;
	if (!file.open(path.string(), 3)) cannotWrite(path);
	mrpt::serialization::archiveFrom(file) << map;
}
}  // namespace

void OtherMapsOptions::describe(OptionFields& fields)
{
	for (std::size_t i = 0; i < maps.size(); ++i)
		fields.integer(maps[i] + kCount, counts[i], 0, 99, "how many of them");
	fields.number(
		"scan_below", scanBelow, 0, 10,
		"for maps that take 2D scans: of the points so far below the camera [m]");
	fields.number("scan_above", scanAbove, 0, 10, "and so far above it [m]");
}

std::vector<std::string> otherMapsSections(const mrpt::config::CConfigFileBase& config)
{
	std::vector<std::string> sections;
	config.getAllSections(sections);
	sections.erase(
		std::remove_if(
			sections.begin(), sections.end(),
			[](const std::string& section) { return section.rfind(kSection + "_", 0) != 0; }),
		sections.end());
	return sections;
}

OtherMaps::OtherMaps(const mrpt::config::CConfigFileBase& config)
{
	options_.maps = countedMaps(config);
	options_.counts.assign(options_.maps.size(), 0);
	options_.loadFromConfigFile(config, kSection);
	for (std::size_t i = 0; i < options_.maps.size(); ++i)
		for (int index = 0; index < options_.counts[i]; ++index)
		{
			const std::string& map = options_.maps[i];
			names_.push_back(nameOf(map, index));
			const mrpt::maps::TMetricMapInitializer::Ptr definition(
				mrpt::maps::TMetricMapInitializer::factory(map));
			const std::string section = kSection + "_" + names_.back();
			definition->loadFromConfigFile(config, section);
			requireMakeable(definition, configFileName(config) + ": [" + section + "_...]");
			definitions_.push_back(definition);
		}
	requireSectionsOf(names_, config);
}

mrpt::maps::CMultiMetricMap::Ptr OtherMaps::build(const SemanticSlam& slam) const
{
	const auto maps = mrpt::maps::CMultiMetricMap::Create();
	maps->setListOfMaps(definitions_);
	for (const auto& key : slam.keyFrames())
	{
		const auto scan = scanWithPoints(*key.scan, slam.map().insertionOptions.maxDepth);
		const CPose3D T_world_sensor =
			slam.poseGraph().pose(NodeId::camera(key.frame)) + (-sensorFromCamera());
		const CPose3D robot = T_world_sensor + (-scan->sensorPose);
		const CPose3D level = levelled(T_world_sensor);
		const auto flat = horizontalScan(*scan, (-level) + T_world_sensor, options_);
		for (const auto& map : maps->maps)
		{
			const bool taken = map->insertObservation(*scan, robot);
			map->insertObservation(*key.instances, robot);
			if (!taken) map->insertObservation(flat, level);
		}
	}
	return maps;
}

void writeOtherMaps(
	const std::string& folder, const std::vector<std::string>& names,
	const mrpt::maps::CMultiMetricMap& maps)
{
	const fs::path overview = fs::path(folder) / "maps.3Dscene";
	if (fs::exists(overview)) fs::remove_all(folder);
	if (names.empty()) return;
	fs::create_directories(folder);
	mrpt::opengl::COpenGLScene scene;
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		const auto& map = *maps.maps[i];
		const fs::path path = fs::path(folder) / names[i];
		map.saveMetricMapRepresentationToFile(path.string());
		const bool grid = dynamic_cast<const mrpt::maps::COccupancyGridMap2D*>(&map) != nullptr;
		saveWhole(path.string() + (grid ? ".gridmap" : ".metricmap"), map);
		const auto picture = mrpt::opengl::CSetOfObjects::Create();
		picture->setName(names[i]);
		map.getVisualizationInto(*picture);
		scene.insert(picture);
	}
	if (!scene.saveToFile(overview.string())) cannotWrite(overview);
}

}  // namespace semloop
