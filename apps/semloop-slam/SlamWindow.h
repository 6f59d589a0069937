#pragma once

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "RunControl.h"
#include "SlamSnapshot.h"

namespace semloop
{
/** A window in a thread of its own that shows a run: picture with masks, map, trajectories, numbers.
 *  Buttons and keys: pause or go on (space), one frame (S, right arrow). One at a time in a process. */
class SlamWindow
{
public:
	/** Opens it; throws InputError when there is no display or no OpenGL 3.3. */
	explicit SlamWindow(const std::string& title);
	/** Closes it. A display that is gone, before or now, ends the window, not the run. */
	~SlamWindow();
	SlamWindow(const SlamWindow&) = delete;
	SlamWindow& operator=(const SlamWindow&) = delete;

	/** Shows the run's state after a frame; frames that come faster than they are drawn are left out.
	 *  To be called in the thread that runs `slam`; waits for nothing. */
	void show(
		const SlamFrame& frame, const SemanticSlam& slam, const StageTimings& timings,
		const WindowNews& news = {})
	{
		show(&frame, slam, timings, news);
	}
	/** The same between frames, as when the camera stalls. */
	void show(const SemanticSlam& slam, const StageTimings& timings, const WindowNews& news)
	{
		show(nullptr, slam, timings, news);
	}
	/** Returns at once unless the user has paused; else when the run shall go on, by a frame at least,
	 *  after Ctrl-C, and when the window is closed. */
	void waitWhilePaused() { control_.waitWhilePaused(); }
	/** False once the user has closed it: the run goes on without it. */
	bool isOpen() const { return open_; }
	/** The display is gone: a thread stays behind that no destructor may disturb (leaveAtOnce). */
	bool isLost() const { return isLost_; }

private:
	void run(const std::string& title, std::promise<void> opened);
	void noteLost();
	void show(
		const SlamFrame* frame, const SemanticSlam& slam, const StageTimings& timings,
		const WindowNews& news);
	std::optional<SlamSnapshot> takeNews();

	RunControl control_;
	SnapshotTaker taker_;
	std::atomic<bool> open_{false}, leave_{false}, isLost_{false};
	std::mutex mutex_;  //!< of what follows
	std::optional<SlamSnapshot> news_;
	bool hasLeft_ = false;
	std::condition_variable left_;
	std::thread thread_;
};

}  // namespace semloop
