#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <semloop/sensors/SensorSource.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ObservationQueue.h"
#include "SensorClock.h"

namespace semloop
{
/** What the grabbing thread and the owner of a SensorSource share. */
struct SensorSource::Channel
{
	using Clock = std::chrono::steady_clock;

	Channel(
		mrpt::hwdrivers::CGenericSensor::Ptr grabbed, std::string name,
		const SensorSourceOptions& options, Tap tap);

	/** The thread's body. */
	void run();
	/** There will be no more from the sensor than what it is at. */
	void end(std::exception_ptr why);
	/** To be called with the mutex held, as all below. */
	bool isOver() const;
	/** The oldest observation that waits; null when none does. */
	mrpt::obs::CObservation::Ptr pop() { return queue_.pop(); }

	const std::string name;
	mutable std::mutex mutex;
	mutable std::condition_variable changed;
	SensorCounts counts;
	bool isStarted = false;                      //!< the driver is initialized
	Clock::time_point lastFrame = Clock::now();  //!< or the start
	std::string lastOther;                       //!< class of what came that is no frame
	std::vector<std::string> news;               //!< for a person
	std::atomic<bool> stopped{false};
	bool returned = false;  //!< from the driver: the thread is at its end
	std::exception_ptr error;

private:
	void grabAll();
	void push(const mrpt::obs::CObservation::Ptr& observation);
	void waitForNextTurn(Clock::time_point turn, bool idle) const;

	mrpt::hwdrivers::CGenericSensor::Ptr sensor_;  //!< the thread's, as the next two
	const Tap tap_;
	SensorClock clock_;

	ObservationQueue queue_;
	bool ended_ = false;
	Clock::time_point endedAt_;
};

}  // namespace semloop
