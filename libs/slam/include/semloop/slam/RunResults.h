#pragma once

#include <semloop/sensors/SensorRecorder.h>
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
	SensorRecorder::Counts recorder;
};

/** What only the caller of SemanticSlam knows about a run. */
struct RunInfo
{
	std::string rawlog;  //!< or the sensor
	std::string config;
	std::size_t skippedFrames = 0;
	std::vector<std::string> warnings;          //!< about them, not about all when they are many
	std::string endedBy = "end of the rawlog";  //!< or what stopped the run
	double wallSeconds = 0.0;
	std::optional<LiveCounts> live;
};

/** Writes every file of a run (doc/file-formats.md) into an existing folder; stale object meshes of
 *  an earlier run are removed. Throws InputError naming the first file that
 *  cannot be written, after all others. */
void writeRunResults(
	const std::string& folder, const SemanticSlam& slam, const RunInfo& info,
	const StageTimings& timings);

/** loops.jsonl: one JSON object a line, without anything that depends on the machine's speed. */
std::string loopsAsJsonLines(const std::vector<LoopRecord>& loops);

}  // namespace semloop
