#pragma once

#include <string>
#include <vector>

namespace semloop
{
struct SlamRunArguments
{
	std::string config;
	std::string rawlog;
	std::string output;
	std::string instances;               //!< empty: the sidecar beside the rawlog, if any
	std::vector<std::string> overrides;  //!< section.key=value
	std::size_t maxFrames = 0;           //!< 0: all
};

/** Maps a rawlog and writes the results, whatever ends the run. Returns an exit code; throws what
 *  makes a run impossible from the start. */
int runSlam(const SlamRunArguments& arguments);

}  // namespace semloop
