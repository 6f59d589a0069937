#include "RunControl.h"

#include <chrono>

#include "StopSignal.h"

namespace semloop
{
namespace
{
// A signal handler cannot wake a thread that waits.
constexpr std::chrono::milliseconds kBetweenLooksAtCtrlC(100);
}  // namespace

void RunControl::togglePause()
{
	const std::lock_guard lock(mutex_);
	paused_ = !paused_;
	steps_ = 0;
	changed_.notify_all();
}

void RunControl::step()
{
	const std::lock_guard lock(mutex_);
	// The frame that is at work when the run is paused is the step.
	if (paused_) ++steps_;
	paused_ = true;
	changed_.notify_all();
}

bool RunControl::isPaused() const
{
	const std::lock_guard lock(mutex_);
	return paused_;
}

void RunControl::release()
{
	const std::lock_guard lock(mutex_);
	paused_ = false;
	changed_.notify_all();
}

void RunControl::waitWhilePaused()
{
	std::unique_lock lock(mutex_);
	while (paused_ && steps_ == 0 && !stopRequested())
		changed_.wait_for(lock, kBetweenLooksAtCtrlC);
	if (paused_ && steps_ > 0) --steps_;
}

}  // namespace semloop
