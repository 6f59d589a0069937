#pragma once

#include <semloop/sensors/SensorSource.h>
#include <semloop/slam/SemanticSlam.h>
#include <semloop/slam/StageTimings.h>

#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** What became of the frames of a live run. */
struct LiveCounts
{
	SensorCounts sensor;
	std::size_t unsegmented = 0;  //!< tracked, but without instances for lack of time
};

/** What only the caller of SemanticSlam knows about a run. */
struct RunInfo
{
	std::string rawlog;  //!< or the sensor
	std::string config;
	std::vector<std::string> skippedFrames;     //!< one warning each
	std::string endedBy = "end of the rawlog";  //!< or what stopped the run
	double wallSeconds = 0.0;
	std::optional<LiveCounts> live;
};

/** Writes every file of a run (doc/file-formats.md) into an existing folder; stale object meshes of
 *  an earlier run are removed. Throws InputError naming the file that cannot be written. */
void writeRunResults(
	const std::string& folder, const SemanticSlam& slam, const RunInfo& info,
	const StageTimings& timings);

/** loops.jsonl: one JSON object a line, without anything that depends on the machine's speed. */
std::string loopsAsJsonLines(const std::vector<LoopRecord>& loops);

}  // namespace semloop
