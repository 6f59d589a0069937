#pragma once

#include <mrpt/config/CConfigFile.h>
#include <semloop/simulation/SceneBuilder.h>

#include <filesystem>
#include <string>
#include <vector>

namespace semloop
{
/** The scenes of config_ini/scenes. */
inline const std::vector<std::string> kScenes{"apartment", "office", "corridor", "no_loop"};
constexpr uint64_t kSeeds = 5;  //!< of each, from 1

inline SceneDescription describe(const std::string& name)
{
	const mrpt::config::CConfigFile config(
		SEMLOOP_SOURCE_DIR "/config_ini/scenes/" + name + ".ini");
	return SceneDescription::load(config, {"depth_sensor", "color_sensor", "detector", "odometry"});
}

/** That of the package sweethome3d-furniture, which may be missing. */
inline bool hasFurniture()
{
	return std::filesystem::exists(FurnitureCatalog::kDefaultFolder);
}

inline const FurnitureCatalog& catalog()
{
	static const auto all = FurnitureCatalog::open();
	return all;
}
}  // namespace semloop
