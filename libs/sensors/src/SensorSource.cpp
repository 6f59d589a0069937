#include <mrpt/core/format.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/hwdrivers/COpenNI2Generic.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/sensors/RecordedSensor.h>
#include <semloop/sensors/SensorSource.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "UnplugListener.h"

using mrpt::hwdrivers::CGenericSensor;
using mrpt::obs::CObservation;

namespace semloop
{
namespace
{
using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Inertial units and the like come faster than frames, and weigh nothing.
constexpr std::size_t kOthersPerFrame = 100;
constexpr std::chrono::seconds kPatienceWithDriver{2};
// Who is told that a camera was unplugged may be before its last frame.
constexpr std::chrono::milliseconds kPatienceForLastFrame{300};

CGenericSensor::Ptr makeSensor(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	const std::string place = configFileName(config) + ": [" + section + "]";
	if (!config.sectionExists(section))
		throw UsageError(place + ": no such section; it describes the sensor, see config_ini/");
	const std::string driver = config.read_string(section, "driver", "");
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

std::vector<CObservation::Ptr> observationsOf(CGenericSensor& sensor)
{
	std::vector<CObservation::Ptr> result;
	for (const auto& [time, object] : sensor.getObservations())
	{
		if (const auto observation = std::dynamic_pointer_cast<CObservation>(object))
			result.push_back(observation);
		if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
			result.insert(result.end(), frame->begin(), frame->end());
	}
	return result;
}

/** COpenNI2Sensor says nothing when there is none, and ends the process when it is destroyed: then it
 *  must live for ever. */
void requireDevice(CGenericSensor::Ptr& sensor, const std::string& name)
{
	static auto& immortal = *new std::vector<CGenericSensor::Ptr>;
	const auto* openni = dynamic_cast<const mrpt::hwdrivers::COpenNI2Generic*>(sensor.get());
	if (!openni || openni->getNumDevices() > 0) return;
	immortal.push_back(std::move(sensor));
	throw InputError(name + ": no OpenNI2 device; plug one in, and see that this user may open it");
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

/** What the grabbing thread and its owner share. */
struct SensorSource::Channel
{
	CGenericSensor::Ptr sensor;  //!< the thread's
	std::string name;
	SensorSourceOptions options;
	Tap tap;
	std::optional<mrpt::Clock::duration> restamp;

	mutable std::mutex mutex;
	mutable std::condition_variable changed;
	std::deque<CObservation::Ptr> queue;
	std::size_t frames = 0;  //!< in the queue
	SensorCounts counts;
	SteadyClock::time_point lastGrab = SteadyClock::now();
	std::atomic<bool> stopped{false};
	bool ended = false;  //!< there will be no more than what it is at
	SteadyClock::time_point endedAt;
	bool returned = false;  //!< from the driver: the thread is at its end
	std::exception_ptr error;

	void run();
	void grabAll();
	void end(std::exception_ptr why);
	bool isOver() const
	{
		return ended && (returned || SteadyClock::now() - endedAt > kPatienceForLastFrame);
	}
	void push(const CObservation::Ptr& observation);
	void waitForNextTurn(SteadyClock::time_point turn, bool idle) const;
};

void SensorSource::Channel::run()
{
	std::exception_ptr failure;
	try
	{
		grabAll();
	}
	catch (const InputError&)
	{
		failure = std::current_exception();
	}
	catch (const std::exception& e)
	{
		failure = std::make_exception_ptr(InputError(name + ": " + exceptionMessage(e)));
	}
	sensor.reset();
	end(std::move(failure));
	const std::lock_guard lock(mutex);
	returned = true;
	changed.notify_all();
}

void SensorSource::Channel::end(std::exception_ptr why)
{
	const std::lock_guard lock(mutex);
	if (std::exchange(ended, true)) return;
	endedAt = SteadyClock::now();
	error = std::move(why);
	changed.notify_all();
}

void SensorSource::Channel::grabAll()
{
	sensor->initialize();
	requireDevice(sensor, name);
	const auto listener = UnplugListener::listenFor(
		*sensor,
		[this] { end(std::make_exception_ptr(InputError(name + ": the camera was unplugged"))); });
	const auto* recorded = dynamic_cast<const RecordedSensor*>(sensor.get());
	while (!stopped)
	{
		const auto turn = SteadyClock::now();
		const bool atEnd = recorded && recorded->isAtEnd();
		if (!atEnd) sensor->doProcess();
		const auto grabbed = observationsOf(*sensor);
		for (const auto& observation : grabbed) push(observation);
		if (atEnd) return;
		if (sensor->getState() == CGenericSensor::ssError)
			throw InputError(name + ": the sensor reports an error; is it still plugged in?");
		waitForNextTurn(turn, grabbed.empty());
	}
}

void SensorSource::Channel::waitForNextTurn(SteadyClock::time_point turn, bool idle) const
{
	const double rate = sensor->getProcessRate();
	const Seconds period(rate > 0 ? 1.0 / rate : idle ? 0.001 : 0.0);
	std::unique_lock lock(mutex);
	changed.wait_until(
		lock, turn + std::chrono::duration_cast<SteadyClock::duration>(period),
		[&] { return stopped.load(); });
}

void SensorSource::Channel::push(const CObservation::Ptr& observation)
{
	if (options.startTime > 0)
	{
		if (!restamp) restamp = mrpt::Clock::fromDouble(options.startTime) - observation->timestamp;
		observation->timestamp += *restamp;
	}
	// Left behind by its owner, a thread that comes back keeps silent.
	if (stopped) return;
	if (tap) tap(observation);

	const std::lock_guard lock(mutex);
	const auto isFrame = [](const CObservation::Ptr& o)
	{ return std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(o) != nullptr; };
	lastGrab = SteadyClock::now();
	++counts.grabbed;
	queue.push_back(observation);
	frames += isFrame(observation);
	const auto capacity = std::size_t(options.queueLength);
	if (frames > capacity)
	{
		queue.erase(std::find_if(queue.begin(), queue.end(), isFrame));
		--frames;
		++counts.dropped;
	}
	else if (queue.size() > frames + kOthersPerFrame * capacity)
	{
		frames -= isFrame(queue.front());
		queue.pop_front();
		++counts.dropped;
	}
	changed.notify_all();
}

SensorSource::SensorSource(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const SensorSourceOptions& options, Tap tap, Report report)
	: options_(options), report_(std::move(report)), channel_(std::make_shared<Channel>())
{
	channel_->sensor = makeSensor(config, section);
	name_ = "[" + section + "] " + channel_->sensor->GetRuntimeClass()->className;
	channel_->name = name_;
	channel_->options = options;
	channel_->tap = std::move(tap);
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
	const auto hasNews = [&]
	{ return !channel.queue.empty() || channel.isOver() || channel.stopped; };
	while (!channel.changed.wait_for(lock, Seconds(0.1), hasNews))
		noteSilence(SteadyClock::now() - channel.lastGrab);
	if (std::exchange(silent_, false) && !channel.queue.empty()) report_(name_ + ": frames again");
	if (!channel.queue.empty())
	{
		const auto observation = channel.queue.front();
		channel.queue.pop_front();
		channel.frames -=
			std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation) != nullptr;
		return observation;
	}
	if (channel.error) std::rethrow_exception(std::exchange(channel.error, nullptr));
	return nullptr;
}

void SensorSource::noteSilence(Seconds silence)
{
	if (silence > Seconds(options_.lostAfter))
		throw InputError(
			name_ + mrpt::format(": no frame for %.1f s; was it unplugged? ", silence.count()) +
			"([live] lost_after is how long to wait)");
	SensorCounts& counts = channel_->counts;
	// A sensor may take its time to start.
	if (silence < Seconds(options_.stallAfter) || counts.grabbed == 0) return;
	if (!std::exchange(silent_, true))
	{
		++counts.stalls;
		report_(name_ + mrpt::format(": no frame for %.1f s, waiting", silence.count()));
	}
	counts.longestStall = std::max(counts.longestStall, silence.count());
}

std::vector<std::string> sensorSections(const mrpt::config::CConfigFileBase& config)
{
	std::vector<std::string> all, result;
	config.getAllSections(all);
	std::copy_if(
		all.begin(), all.end(), std::back_inserter(result),
		[&](const std::string& section)
		{
			return std::any_of(
				all.begin(), all.end(),
				[&](const std::string& sensor)
				{
					return config.keyExists(sensor, "driver") &&
						   (section == sensor || section.rfind(sensor + "_", 0) == 0);
				});
		});
	return result;
}

}  // namespace semloop
