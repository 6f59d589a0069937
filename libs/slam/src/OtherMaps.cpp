#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/COccupancyGridMap3D.h>
#include <mrpt/maps/TMetricMapTypesRegistry.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/config/Options.h>
#include <semloop/slam/OtherMaps.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "KeyFrameObservations.h"

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

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

/** How many of each map. */
class Counts : public Options
{
public:
	explicit Counts(std::vector<std::string> maps) : maps_(std::move(maps)), counts_(maps_.size())
	{
	}
	const std::vector<std::string>& maps() const { return maps_; }
	int of(std::size_t map) const { return counts_[map]; }

protected:
	void describe(OptionFields& fields) override
	{
		for (std::size_t i = 0; i < maps_.size(); ++i)
			fields.integer(maps_[i] + kCount, counts_[i], 0, 99, "how many of them");
	}

private:
	std::vector<std::string> maps_;
	std::vector<int> counts_;
};

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

/** A map that takes the points gets no horizontal scan. */
void insert(const KeyFrameObservations& observations, mrpt::maps::CMetricMap& map)
{
	// It leaves other points in the scan than it found, for the maps behind it.
	const bool spoils = dynamic_cast<mrpt::maps::COccupancyGridMap3D*>(&map) != nullptr;
	bool hasPoints = false;
	for (const auto& observation : *observations.frame)
	{
		const auto& isA = observation->GetRuntimeClass();
		if (hasPoints && isA == CLASS_ID(mrpt::obs::CObservation2DRangeScan)) continue;
		const auto given = spoils ? std::dynamic_pointer_cast<mrpt::obs::CObservation>(
										observation->duplicateGetSmartPtr())
								  : observation;
		const bool taken = map.insertObservation(*given, observations.T_world_robot);
		hasPoints = hasPoints || (taken && isA == CLASS_ID(CObservation3DRangeScan));
	}
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
	Counts counts(countedMaps(config));
	counts.loadFromConfigFile(config, kSection);
	for (std::size_t i = 0; i < counts.maps().size(); ++i)
		for (int index = 0; index < counts.of(i); ++index)
		{
			const std::string& map = counts.maps()[i];
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
	for (const auto& map : maps->maps)
		// With MRPT's 8 images must have sides that are multiples of it, and no ini file can say 1.
		if (const auto grid = std::dynamic_pointer_cast<mrpt::maps::COccupancyGridMap3D>(map))
			grid->insertionOptions.decimation_3d_range = 1;
	for (const auto& key : slam.keyFrames())
	{
		const auto observations = keyFrameObservations(slam, key);
		// Without what is too far to trust, for maps that look at the image and not at the points.
		cutDepth(
			*observations.frame->getObservationByClass<CObservation3DRangeScan>(),
			slam.map().insertionOptions.maxDepth);
		for (const auto& map : maps->maps) insert(observations, *map);
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
