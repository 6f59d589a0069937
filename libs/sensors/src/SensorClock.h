#pragma once

#include <mrpt/obs/CObservation.h>

#include <chrono>
#include <optional>

namespace semloop
{
/** Keeps the times of a sensor's observations in order where the computer's clock does not: one that is
 *  missing is now; and when the clock is set back, times go on from the last, as fast as they come. */
class SensorClock
{
public:
	/** Unix time that the first observation gets [s]; 0: as the sensor says. */
	explicit SensorClock(double startTime) : startTime_(startTime) {}

	/** Corrects the observation's time; true when the clock was set back before it. */
	bool correct(mrpt::obs::CObservation& observation);

private:
	double startTime_;
	mrpt::Clock::duration offset_{0};
	std::optional<mrpt::Clock::time_point> last_;
	std::chrono::steady_clock::time_point lastCame_;
};

}  // namespace semloop
