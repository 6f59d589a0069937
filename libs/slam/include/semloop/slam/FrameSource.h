#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/segmentation/Embedder.h>
#include <semloop/segmentation/Segmenter.h>
#include <semloop/slam/StageTimings.h>

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace semloop
{
/** One frame, ready for mapping: images and masks rectified. */
struct SlamFrame
{
	RgbdFrame rgbd;
	CObservationInstances::Ptr instances;              //!< null: this frame was not segmented
	mrpt::obs::CObservation3DRangeScan::Ptr scan;      //!< as recorded
	std::vector<mrpt::obs::CObservation::Ptr> before;  //!< other observations since the last frame
	std::vector<std::string> skipped;  //!< warnings: damaged frames between the last one and this
	double progress = 0.0;             //!< share of the rawlog read so far
};

/** Reads, segments and rectifies the frames of a rawlog, ahead of the consumer in a thread of its own
 *  when asked to. Every frame is handled, in order, so the result does not depend on timing.
 *
 *  A frame that cannot be used (image missing or unreadable, sizes that do not fit, no valid depth)
 *  is skipped and told in SlamFrame::skipped. What ends the recording early (file cut, time going
 *  backwards, a network that fails) is thrown by next(), after all good frames before it. */
class FrameSource
{
public:
	FrameSource(
		const std::string& rawlog, std::shared_ptr<Segmenter> segmenter,
		std::shared_ptr<Embedder> embedder, int framesAhead, StageTimings& timings);
	~FrameSource();

	/** Empty at the end of the recording. */
	std::optional<SlamFrame> next();
	/** Warnings about frames behind the last good one; complete when next() has ended. */
	const std::vector<std::string>& skippedAtEnd() const { return pendingSkipped_; }

private:
	class Queue;

	std::optional<SlamFrame> produce();
	mrpt::obs::CObservation::Ptr read();
	void lookAhead();
	/** False: the frame is to be skipped; why is in pendingSkipped_. */
	bool prepare(const mrpt::obs::CObservation3DRangeScan::Ptr& scan, SlamFrame& frame);
	void segment(const RgbdFrame& raw, SlamFrame& frame);
	void requireSize(const CObservationInstances& recorded, const RgbdFrame& raw) const;
	void checkTime(const mrpt::obs::CObservation3DRangeScan& scan);

	std::shared_ptr<Segmenter> segmenter_;
	std::shared_ptr<Embedder> embedder_;
	StageTimings& timings_;
	RawlogReader reader_;
	Rectifier rectifier_;
	mrpt::obs::CObservation::Ptr lookAhead_;
	std::exception_ptr readError_;
	std::vector<mrpt::obs::CObservation::Ptr> pendingOthers_;
	std::vector<std::string> pendingSkipped_;
	std::optional<mrpt::Clock::time_point> lastTime_;
	std::unique_ptr<Queue> queue_;  //!< null without a thread
	std::thread thread_;
};

}  // namespace semloop
