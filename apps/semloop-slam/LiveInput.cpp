#include "LiveInput.h"

#include <semloop/config/ExceptionMessage.h>
#include <semloop/slam/LiveFrames.h>

#include <chrono>

namespace semloop
{
LiveInput::LiveInput(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const std::string& record)
{
	options_.loadFromConfigFile(config, "live");
	const auto report = [news = news_](const std::string& line) { news->add(line); };
	SensorSource::Tap tap;
	if (!record.empty())
	{
		recorder_ = std::make_shared<SensorRecorder>(record, report);
		tap = [recorder = recorder_](const mrpt::obs::CObservation::Ptr& observation)
		{ recorder->write(observation); };
	}
	sensor_ = std::make_unique<SensorSource>(config, section, options_, tap, report);
}

std::string LiveInput::run(
	MappingLoop& loop, const FrontEnd& frontEnd, SemanticSlam& slam, StageTimings& timings,
	RunInfo& info)
{
	std::string failure;
	{
		LiveFrames frames(*sensor_, frontEnd, slam, options_, timings);
		failure = loop.run(frames, *sensor_, *news_);
	}
	if (!recorder_) return failure;
	try
	{
		recorder_->close();
	}
	catch (const std::exception& e)
	{
		failure += (failure.empty() ? "" : "; and ") + exceptionMessage(e);
	}
	info.live->recorder = recorder_->counts();
	return failure;
}

bool LiveInput::isStuck() const
{
	using namespace std::chrono_literals;
	return sensor_->isStuck(2s);
}

}  // namespace semloop
