#include <mrpt/core/format.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/hwdrivers/COpenNI2Generic.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/config/ReadText.h>
#include <semloop/sensors/COniFileSensor.h>
#include <semloop/sensors/SensorSource.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "OpenNi2.h"
#include "SensorChannel.h"

using mrpt::hwdrivers::CGenericSensor;
using mrpt::obs::CObservation;

namespace semloop
{
namespace
{
using Seconds = std::chrono::duration<double>;

constexpr std::chrono::seconds kPatienceWithDriver{2};

CGenericSensor::Ptr makeSensor(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	const std::string place = configFileName(config) + ": [" + section + "]";
	if (!config.sectionExists(section))
		throw UsageError(place + ": no such section; it describes the sensor, see config_ini/");
	const std::string driver = readText(config, section, "driver");
	if (driver.empty())
		throw UsageError(place + " driver: missing; name a sensor's class, as COpenNI2Sensor");
	const auto sensor = CGenericSensor::createSensorPtr(driver);
	if (!sensor)
		throw UsageError(
			place + " driver = " + driver +
			": no such sensor class; MRPT's are CGenericSensor's descendants, as COpenNI2Sensor, "
			"one "
			"of a plug-in needs [modules] plugins");
	try
	{
		sensor->loadConfig(config, section);
	}
	catch (const std::exception& e)
	{
		throw UsageError(place + ": " + driver + ": " + exceptionMessage(e));
	}
	return sensor;
}
}  // namespace

void SensorSourceOptions::describe(OptionFields& f)
{
	f.integer("queue_length", queueLength, 1, 10000, "frames waiting; then the oldest are dropped");
	f.number("stall_after", stallAfter, 0.01, 3600, "silence of the sensor that is reported [s]");
	f.number("lost_after", lostAfter, 0.01, 3600, "silence after which it is given up [s]");
	f.number(
		"start_time", startTime, 0, 1e11,
		"Unix time of the first observation, for a sensor that plays what has recorded instances "
		"or "
		"odometry [s]; 0: as the sensor says");
}

void SensorSourceOptions::requireConsistent() const
{
	if (lostAfter < stallAfter) throw UsageError("lost_after must be at least stall_after");
}

SensorSource::SensorSource(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const SensorSourceOptions& options, Tap tap, Report report)
	: options_(options), report_(std::move(report))
{
	const auto sensor = makeSensor(config, section);
	if (std::dynamic_pointer_cast<mrpt::hwdrivers::COpenNI2Generic>(sensor) ||
		std::dynamic_pointer_cast<COniFileSensor>(sensor))
		startOpenNi2();
	name_ = "[" + section + "] " + sensor->GetRuntimeClass()->className;
	channel_ = std::make_shared<Channel>(sensor, name_, options, std::move(tap));
	std::thread([channel = channel_] { channel->run(); }).detach();
}

SensorSource::~SensorSource()
{
	stop();
	isStuck(kPatienceWithDriver);
}

void SensorSource::stop()
{
	const std::lock_guard lock(channel_->mutex);
	channel_->stopped = true;
	channel_->changed.notify_all();
}

bool SensorSource::isStuck(std::chrono::milliseconds patience) const
{
	std::unique_lock lock(channel_->mutex);
	return !channel_->changed.wait_for(lock, patience, [&] { return channel_->returned; });
}

SensorCounts SensorSource::counts() const
{
	const std::lock_guard lock(channel_->mutex);
	return channel_->counts;
}

CObservation::Ptr SensorSource::next()
{
	Channel& channel = *channel_;
	std::unique_lock lock(channel.mutex);
	CObservation::Ptr observation;
	const auto isDecided = [&]
	{
		observation = channel.pop();
		return observation || channel.isOver() || channel.stopped;
	};
	for (const std::string& line : std::exchange(channel.news, {})) report_(line);
	for (bool decided = isDecided(); !decided;)
	{
		watch();
		decided = channel.changed.wait_for(lock, Seconds(0.1), isDecided);
	}
	if (silent_ && Channel::Clock::now() - channel.lastFrame < Seconds(options_.stallAfter))
	{
		silent_ = false;
		report_(name_ + ": frames again");
	}
	if (observation) return observation;
	if (channel.error) std::rethrow_exception(std::exchange(channel.error, nullptr));
	return nullptr;
}

void SensorSource::watch()
{
	const Seconds silence = std::chrono::steady_clock::now() - channel_->lastFrame;
	const std::string text = mrpt::format("no frame for %.1f s", silence.count());
	SensorCounts& counts = channel_->counts;
	if (!channel_->isStarted)
	{
		if (silence > Seconds(options_.lostAfter) && !std::exchange(toldOfStart_, true))
			report_(name_ + ": still starting; Ctrl-C ends it");
		return;
	}
	if (silence < Seconds(options_.stallAfter)) return;
	if (silence > Seconds(options_.lostAfter)) throw InputError(name_ + ": " + text + whyLost());
	if (!std::exchange(silent_, true))
	{
		++counts.stalls;
		report_(name_ + ": " + text + ", waiting");
	}
	counts.longestStall = std::max(counts.longestStall, silence.count());
}

std::string SensorSource::whyLost() const
{
	const std::string& other = channel_->lastOther;
	return other.empty() ? "; was it unplugged? ([live] lost_after is how long to wait)"
						 : ", only " + other +
							   "; is it an RGB-D camera (CObservation3DRangeScan), and plugged in?";
}

std::vector<std::string> sensorSections(const mrpt::config::CConfigFileBase& config)
{
	std::vector<std::string> all, sensors, result;
	config.getAllSections(all);
	std::copy_if(
		all.begin(), all.end(), std::back_inserter(sensors),
		[&](const std::string& section) { return config.keyExists(section, "driver"); });
	for (const std::string& section : all)
	{
		const bool isOfSensor = std::any_of(
			sensors.begin(), sensors.end(),
			[&](const std::string& sensor)
			{ return section == sensor || section.rfind(sensor + "_", 0) == 0; });
		if (isOfSensor || (section == "global" && !sensors.empty())) result.push_back(section);
	}
	return result;
}

}  // namespace semloop
