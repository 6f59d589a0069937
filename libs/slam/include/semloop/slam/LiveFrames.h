#pragma once

#include <semloop/observations/ObservationSource.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/slam/FrameBuilder.h>
#include <semloop/slam/FrontEnd.h>
#include <semloop/slam/LiveOptions.h>
#include <semloop/slam/SemanticSlam.h>
#include <semloop/slam/StageTimings.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace semloop
{
/** A frame that odometry has followed, on its way to the map. */
struct TrackedFrame
{
	SlamFrame frame;
	OdometryEstimate odometry;
};

/** Frames of a sensor that does not wait. Three things go on at a time:
 *
 *    tracking      every frame that comes is rectified and followed by odometry    own thread
 *    segmentation  of those that there is time for                                 own thread
 *    mapping       all frames in order, those not segmented for their pose only    who calls next()
 *
 *  Segmentation never holds up tracking: a frame that finds no room in a queue (LiveOptions) goes on without
 *  instances and without its images, so memory stays bounded too. It is counted in unsegmented(). */
class LiveFrames
{
public:
	/** Calls slam.track() in the tracking thread; the rest of slam is for who calls next(). */
	LiveFrames(
		ObservationSource& sensor, FrontEnd frontEnd, SemanticSlam& slam,
		const LiveOptions& options, StageTimings& timings);
	/** Stops the sensor; what has not been asked for is dropped. */
	~LiveFrames();

	/** The next frame for SemanticSlam::integrate(); nothing when there is none within the patience, or
	 *  no more at all, see hasEnded(). Throws what ended the sensor or the segmentation, after all good
	 *  frames before it. */
	std::optional<TrackedFrame> next(std::chrono::milliseconds patience);
	bool hasEnded() const;

	/** Frames that were tracked, but not segmented, for lack of time. */
	std::size_t unsegmented() const;
	/** Warnings about frames that could not be used, since the last call. */
	std::vector<std::string> takeSkipped();

private:
	struct Waiting
	{
		TrackedFrame tracked;
		RgbdFrame raw;         //!< to be segmented
		bool isReady = false;  //!< for mapping
		bool hasImages = false;
	};

	void trackAll();
	void trackFrame(SlamFrame frame);
	void keepSkipped(std::vector<std::string> warnings);
	void segmentAll();
	void segmentNext(Waiting& frame);
	/** A thread's body; what it throws goes to next(). */
	void runThread(void (LiveFrames::*body)(), bool& ended);
	bool isOver() const { return segmentationEnded_ && (trackingEnded_ || error_); }
	std::size_t readyWithImages() const;

	ObservationSource& sensor_;
	FrontEnd frontEnd_;
	SemanticSlam& slam_;
	LiveOptions options_;
	StageTimings& timings_;
	FrameBuilder builder_;
	Rectifier imageRectifier_, maskRectifier_;  //!< one a thread

	mutable std::mutex mutex_;
	std::condition_variable changed_;
	std::list<Waiting> waiting_;  //!< in order of time; a list: its elements stay put
	std::deque<Waiting*> toSegment_;
	std::size_t unsegmented_ = 0;
	std::vector<std::string> skipped_;
	bool trackingEnded_ = false, segmentationEnded_ = false;
	bool stopped_ = false;
	std::exception_ptr error_;
	std::thread tracking_, segmentation_;
};

}  // namespace semloop
