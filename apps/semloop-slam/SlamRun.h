#pragma once

#include <string>
#include <vector>

namespace semloop
{
struct SlamRunArguments
{
	std::string config;
	std::string rawlog;  //!< empty: live
	std::string sensor;  //!< section of the configuration; empty: not live
	std::string record;  //!< rawlog for what the sensor gives; empty: none
	std::string output;
	std::string instances;               //!< empty: the sidecar beside the rawlog, if any
	std::vector<std::string> overrides;  //!< section.key=value
	bool window = false;
	std::size_t maxFrames = 0;  //!< 0: all
};

/** Maps a rawlog, or what a sensor sees, and writes the results, whatever ends the run. Returns an exit code; throws what
 *  makes a run impossible from the start. */
int runSlam(const SlamRunArguments& arguments);

}  // namespace semloop
