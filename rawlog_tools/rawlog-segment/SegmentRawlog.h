#pragma once

#include "Settings.h"
#include "Sidecar.h"

#include <cstddef>
#include <functional>
#include <string>

namespace semloop
{
/** How a run over a rawlog ended. */
struct SegmentationReport
{
	std::size_t frames = 0;   //!< range scans seen that were to be segmented
	std::size_t skipped = 0;  //!< of these, damaged
	bool stopped = false;     //!< by the user
	std::string inputDamage;  //!< why the rawlog could not be read to its end; empty: it was
};

/** Where a run tells how it goes. */
struct SegmentationEvents
{
	std::function<void(std::size_t frames, double share)> progress;
	std::function<void(const std::string& line)> warning;
	std::function<bool()> stopRequested;
};

/** Segments every n-th colour image with depth of a rawlog and writes what was found to the sidecar,
 *  which is closed unless the user stopped. Frames that are in it already are passed over. */
SegmentationReport segmentRawlog(
	const Arguments& arguments, Networks& networks, Sidecar& sidecar,
	const SegmentationEvents& events);

}  // namespace semloop
