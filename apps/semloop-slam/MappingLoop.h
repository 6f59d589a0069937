#pragma once

#include <semloop/sensors/SensorSource.h>
#include <semloop/slam/FrameSource.h>
#include <semloop/slam/LiveFrames.h>
#include <semloop/slam/RunResults.h>
#include <semloop/slam/SemanticSlam.h>
#include <semloop/slam/StageTimings.h>

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "ProgressBar.h"
#include "SlamWindow.h"

namespace semloop
{
/** One-line news for a person, from any thread. */
class News
{
public:
	void add(const std::string& line);
	std::vector<std::string> take();

private:
	std::mutex mutex_;
	std::vector<std::string> lines_;
};

/** Maps frame after frame until there are no more, the user has had enough, or it fails. */
class MappingLoop
{
public:
	/** Without window when that is null. */
	MappingLoop(
		SemanticSlam& slam, StageTimings& timings, RunInfo& info, ProgressBar& bar,
		SlamWindow* window, std::size_t maxFrames)
		: slam_(slam),
		  timings_(timings),
		  info_(info),
		  bar_(bar),
		  window_(window),
		  maxFrames_(maxFrames)
	{
	}

	/** What ended the run early because of bad input; empty otherwise. */
	std::string run(FrameSource& recording);
	/** Same; the news are those of the sensor. */
	std::string run(LiveFrames& frames, SensorSource& sensor, News& news);

private:
	/** False at --max-frames and, in a recording, at Ctrl-C. */
	bool wantsMore();
	void warn(const std::vector<std::string>& warnings);
	void tell(News& news);
	bool mapNext(FrameSource& recording);
	bool mapNext(LiveFrames& frames, SensorSource& sensor, News& news);
	LiveCounts countsOf(const LiveFrames& frames, const SensorSource& sensor) const;

	SemanticSlam& slam_;
	StageTimings& timings_;
	RunInfo& info_;
	ProgressBar& bar_;
	SlamWindow* window_;  //!< null: none
	std::size_t maxFrames_;
	std::string sensorNews_;  //!< the last
};

extern const char* const kEndedByUser;

}  // namespace semloop
