#pragma once

#include <string>

namespace semloop::virtual_camera
{
/** What the environment asks for; VirtualCamera.cpp lists the variables. */
struct CameraSettings
{
	std::string rawlog;
	double rate = 30.0;  //!< [1/s]
	int drop = 0;        //!< 0: none, as below
	int dropColor = 0;
	int unplug = 0;
	int stallBefore = -1;     //!< a frame's index; -1: none
	double stallSeconds = 0;  //!< [s]
};

/** Throws what is wrong with them, in a line. */
CameraSettings settingsFromEnvironment();

}  // namespace semloop::virtual_camera
