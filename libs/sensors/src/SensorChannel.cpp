#include "SensorChannel.h"

#include <mrpt/hwdrivers/COpenNI2Generic.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/sensors/RecordedSensor.h>

#include <utility>

#include "UnplugListener.h"

using mrpt::hwdrivers::CGenericSensor;
using mrpt::obs::CObservation;

namespace semloop
{
namespace
{
// Who is told that a camera was unplugged may be before its last frame.
constexpr std::chrono::milliseconds kPatienceForLastFrame{300};

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

SensorSource::Channel::Channel(
	CGenericSensor::Ptr grabbed, std::string itsName, const SensorSourceOptions& options, Tap tap)
	: name(std::move(itsName)),
	  sensor_(std::move(grabbed)),
	  tap_(std::move(tap)),
	  clock_(options.startTime),
	  queue_(std::size_t(options.queueLength))
{
}

void SensorSource::Channel::run()
{
	std::exception_ptr failure;
	const auto fail = [&](const std::string& why)
	{ failure = std::make_exception_ptr(InputError(name + ": " + why)); };
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
		fail(exceptionMessage(e));
	}
	catch (...)
	{
		fail("its driver failed, and does not say why");
	}
	sensor_.reset();
	end(std::move(failure));
	const std::lock_guard lock(mutex);
	returned = true;
	changed.notify_all();
}

void SensorSource::Channel::end(std::exception_ptr why)
{
	const std::lock_guard lock(mutex);
	if (std::exchange(ended_, true)) return;
	endedAt_ = Clock::now();
	error = std::move(why);
	changed.notify_all();
}

bool SensorSource::Channel::isOver() const
{
	return ended_ && (returned || Clock::now() - endedAt_ > kPatienceForLastFrame);
}

void SensorSource::Channel::grabAll()
{
	sensor_->initialize();
	requireDevice(sensor_, name);
	{
		const std::lock_guard lock(mutex);
		isStarted = true;
		lastFrame = Clock::now();
	}
	const auto listener = UnplugListener::listenFor(
		*sensor_,
		[this] { end(std::make_exception_ptr(InputError(name + ": the camera was unplugged"))); });
	const auto* recorded = dynamic_cast<const RecordedSensor*>(sensor_.get());
	while (!stopped)
	{
		const auto turn = Clock::now();
		const bool atEnd = recorded && recorded->isAtEnd();
		if (!atEnd) sensor_->doProcess();
		const auto grabbed = observationsOf(*sensor_);
		for (const auto& observation : grabbed) push(observation);
		if (atEnd) return;
		if (sensor_->getState() == CGenericSensor::ssError)
			throw InputError(name + ": the sensor reports an error; is it still plugged in?");
		waitForNextTurn(turn, grabbed.empty());
	}
}

void SensorSource::Channel::waitForNextTurn(Clock::time_point turn, bool idle) const
{
	const double rate = sensor_->getProcessRate();
	const std::chrono::duration<double> period(rate > 0 ? 1.0 / rate : idle ? 0.001 : 0.0);
	std::unique_lock lock(mutex);
	changed.wait_until(
		lock, turn + std::chrono::duration_cast<Clock::duration>(period),
		[&] { return stopped.load(); });
}

void SensorSource::Channel::push(const CObservation::Ptr& observation)
{
	const bool wasSetBack = clock_.correct(*observation);
	const std::lock_guard lock(mutex);
	// Left behind by its owner, a thread that comes back keeps silent.
	if (stopped) return;
	if (tap_) tap_(observation);
	if (wasSetBack) news.push_back(name + ": the clock was set back; times go on from the last");
	++counts.grabbed;
	if (isFrame(*observation))
		lastFrame = Clock::now();
	else
		lastOther = observation->GetRuntimeClass()->className;
	if (queue_.isFullFor(*observation))
	{
		queue_.dropOldestLike(*observation);
		++counts.dropped;
	}
	queue_.push(observation);
	changed.notify_all();
}

}  // namespace semloop
