#pragma once

#include <cstdlib>
#include <map>
#include <string>

namespace semloop
{
/** What to put before a shell command so that OpenNI2 finds the virtual camera and no other device:
 *
 *      shell(virtualCamera("room.rawlog", {{"RATE", "200"}, {"UNPLUG", "20"}}) + "rawlog-grabber ...", folder)
 *
 *  The settings are those of virtual_camera/VirtualCamera.cpp, without SEMLOOP_CAMERA_. An empty rawlog is
 *  a computer without camera. A relative rawlog is looked for in the folder of the command. */
inline std::string virtualCamera(
	const std::string& rawlog, const std::map<std::string, std::string>& settings = {})
{
	const char* const libraries = std::getenv("LD_LIBRARY_PATH");
	std::string words = "LD_LIBRARY_PATH='" SEMLOOP_BINARY_DIR "/openni2";
	if (libraries && *libraries) words += std::string(":") + libraries;
	words += "' SEMLOOP_CAMERA_RAWLOG='" + rawlog + "' ";
	for (const auto& [name, value] : settings)
		words += "SEMLOOP_CAMERA_" + name + "='" + value + "' ";
	return words;
}

}  // namespace semloop
