#pragma once

#include <mrpt/core/Clock.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace semloop
{
struct OniImport
{
	std::string recording;
	std::string rawlog;
	std::string cameraFile;                            //!< empty: as the recording says
	std::optional<mrpt::Clock::time_point> startTime;  //!< without: when the file was last changed
	bool embed = false;                                //!< images inside the rawlog
};

struct OniImportReport
{
	std::size_t frames = 0;
	std::size_t unpairedColor = 0;
	std::size_t unpairedDepth = 0;
	mrpt::Clock::time_point startTime;
	double duration = 0;  //!< from the first frame to the last [s]
};

/** Writes the recording as a rawlog of CObservation3DRangeScan ("RGBD", with the time of the depth image),
 *  depth bit by bit, colour lossless; images to <rawlog>_Images/ unless they are to be inside.
 *
 *  Throws InputError when the recording is wrong or cut; what came before the cut is in <rawlog>.partial
 *  then. progress(frames, share) is called after each frame. */
OniImportReport importOni(
	const OniImport& import, const std::function<void(std::size_t, double)>& progress);

}  // namespace semloop
