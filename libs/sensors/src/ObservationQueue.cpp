#include "ObservationQueue.h"

#include <mrpt/obs/CObservation3DRangeScan.h>

#include <algorithm>

using mrpt::obs::CObservation;

namespace semloop
{
bool isFrame(const CObservation& observation)
{
	return dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation) != nullptr;
}

bool ObservationQueue::isFullFor(const CObservation& observation) const
{
	return isFrame(observation) ? frames_ >= maxFrames_
								: queue_.size() - frames_ >= kOthersPerFrame * maxFrames_;
}

void ObservationQueue::push(const CObservation::Ptr& observation)
{
	queue_.push_back(observation);
	if (isFrame(*observation)) ++frames_;
}

CObservation::Ptr ObservationQueue::pop()
{
	if (queue_.empty()) return nullptr;
	const auto oldest = queue_.front();
	queue_.pop_front();
	if (isFrame(*oldest)) --frames_;
	return oldest;
}

void ObservationQueue::dropOldestLike(const CObservation& observation)
{
	const bool ofFrames = isFrame(observation);
	const auto oldest = std::find_if(
		queue_.begin(), queue_.end(),
		[&](const CObservation::Ptr& o) { return isFrame(*o) == ofFrames; });
	if (oldest == queue_.end()) return;
	queue_.erase(oldest);
	if (ofFrames) --frames_;
}

}  // namespace semloop
