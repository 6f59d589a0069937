#pragma once

#include <semloop/observations/ObservationSource.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/slam/FrameBuilder.h>
#include <semloop/slam/FrontEnd.h>
#include <semloop/slam/SlamFrame.h>
#include <semloop/slam/StageTimings.h>

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace semloop
{
/** Reads, segments and rectifies the frames of a recording, ahead of the consumer in a thread of its own
 *  when asked to. Every frame is handled, in order, so the result does not depend on timing; for a
 *  sensor that does not wait there is LiveFrames.
 *
 *  A frame that cannot be used is skipped (FrameBuilder). What ends the recording early (file cut, time going
 *  backwards, a network that fails) is thrown by next(), after all good frames before it. */
class FrameSource
{
public:
	FrameSource(
		std::unique_ptr<ObservationSource> recording, FrontEnd frontEnd, int framesAhead,
		StageTimings& timings);
	~FrameSource();

	/** Empty at the end of the recording. */
	std::optional<SlamFrame> next();
	/** Warnings about the frames that next() has skipped, since the last call; of none that was only read
	 *  ahead. */
	std::vector<std::string> takeSkipped();

private:
	/** What a call of next() comes to. */
	struct Step
	{
		std::optional<SlamFrame> frame;    //!< empty: the end
		std::vector<std::string> skipped;  //!< on the way to it
		std::exception_ptr error;          //!< that is the end; null: none
	};
	class Queue;

	Step step();
	std::optional<SlamFrame> produce();
	mrpt::obs::CObservation::Ptr read();
	void lookAhead();
	void segment(SlamFrame& frame);
	void requireSize(const CObservationInstances& recorded, const RgbdFrame& raw) const;

	std::unique_ptr<ObservationSource> recording_;
	FrontEnd frontEnd_;
	StageTimings& timings_;
	FrameBuilder builder_;
	Rectifier rectifier_;
	mrpt::obs::CObservation::Ptr lookAhead_;
	std::exception_ptr readError_;
	std::vector<std::string> skipped_;  //!< of the consumer's thread
	std::unique_ptr<Queue> queue_;      //!< null without a thread
	std::thread thread_;
};

}  // namespace semloop
