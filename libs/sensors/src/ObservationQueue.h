#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <deque>

namespace semloop
{
/** Whether it is an RGB-D scan. */
bool isFrame(const mrpt::obs::CObservation& observation);

/** Observations that wait, in the order in which they came. There is room for so many frames, and apart
 *  from them for kOthersPerFrame times as many others. */
class ObservationQueue
{
public:
	// Inertial units and the like come faster than frames, and weigh nothing.
	static constexpr std::size_t kOthersPerFrame = 100;

	explicit ObservationQueue(std::size_t maxFrames) : maxFrames_(maxFrames) {}

	bool isEmpty() const { return queue_.empty(); }
	std::size_t frames() const { return frames_; }
	/** Whether there is no room for one of its kind, a frame or another; push() takes it nevertheless. */
	bool isFullFor(const mrpt::obs::CObservation& observation) const;

	void push(const mrpt::obs::CObservation::Ptr& observation);
	/** The oldest; null when there is none. */
	mrpt::obs::CObservation::Ptr pop();
	/** Drops the oldest of its kind, a frame or another, if any. */
	void dropOldestLike(const mrpt::obs::CObservation& observation);

private:
	std::size_t maxFrames_;
	std::deque<mrpt::obs::CObservation::Ptr> queue_;
	std::size_t frames_ = 0;  //!< in the queue
};

}  // namespace semloop
