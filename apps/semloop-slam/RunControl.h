#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace semloop
{
/** Pause and single steps of a run: asked for in one thread, obeyed in another. */
class RunControl
{
public:
	void togglePause();
	/** One frame, then pause. */
	void step();
	bool isPaused() const;
	/** Nobody is left who could ask: the run goes on. */
	void release();

	/** Returns at once unless paused; else when the run goes on, a step is asked for, or Ctrl-C. */
	void waitWhilePaused();

private:
	mutable std::mutex mutex_;
	std::condition_variable changed_;
	bool paused_ = false;
	std::size_t steps_ = 0;  //!< asked for and not yet made
};

}  // namespace semloop
