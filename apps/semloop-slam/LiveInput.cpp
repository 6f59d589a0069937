#include "LiveInput.h"

#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/slam/LiveFrames.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace semloop
{
LiveInput::LiveInput(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const std::string& record)
{
	options_.loadFromConfigFile(config, "live");
	SensorSource::Tap tap;
	if (!record.empty())
	{
		recorder_ = std::make_shared<SensorRecorder>(record);
		tap = [recorder = recorder_](const mrpt::obs::CObservation::Ptr& observation)
		{ recorder->write(observation); };
	}
	sensor_ = std::make_unique<SensorSource>(
		config, section, options_, tap, [this](const std::string& line) { news_.add(line); });
}

std::string LiveInput::run(
	MappingLoop& loop, const FrontEnd& frontEnd, SemanticSlam& slam, StageTimings& timings)
{
	std::string failure;
	{
		LiveFrames frames(*sensor_, frontEnd, slam, options_, timings);
		failure = loop.run(frames, *sensor_, news_);
	}
	try
	{
		if (recorder_) recorder_->close();
	}
	catch (const InputError& e)
	{
		failure += (failure.empty() ? "" : "; and ") + exceptionMessage(e);
	}
	return failure;
}

void LiveInput::leaveIfStuck(int exitCode) const
{
	using namespace std::chrono_literals;
	if (!sensor_->isStuck(2s)) return;
	std::cout.flush();
	std::cerr.flush();
	std::fflush(nullptr);
	std::_Exit(exitCode);
}

}  // namespace semloop
