#include "SensorClock.h"

namespace semloop
{
namespace
{
// Less is how observations of one sensor overtake each other.
constexpr std::chrono::seconds kSetBack{1};
}  // namespace

bool SensorClock::correct(mrpt::obs::CObservation& observation)
{
	const auto now = std::chrono::steady_clock::now();
	auto& time = observation.timestamp;
	if (time == INVALID_TIMESTAMP) time = mrpt::Clock::now();
	if (!last_ && startTime_ > 0) offset_ = mrpt::Clock::fromDouble(startTime_) - time;
	time += offset_;
	const bool wasSetBack = last_ && time < *last_ - kSetBack;
	if (wasSetBack)
	{
		const auto next =
			*last_ + std::chrono::duration_cast<mrpt::Clock::duration>(now - lastCame_);
		offset_ += next - time;
		time = next;
	}
	last_ = time;
	lastCame_ = now;
	return wasSetBack;
}

}  // namespace semloop
