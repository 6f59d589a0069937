#include <semloop/slam/LiveFrames.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace semloop
{
LiveFrames::LiveFrames(
	ObservationSource& sensor, FrontEnd frontEnd, SemanticSlam& slam, const LiveOptions& options,
	StageTimings& timings)
	: sensor_(sensor),
	  frontEnd_(std::move(frontEnd)),
	  slam_(slam),
	  options_(options),
	  timings_(timings),
	  builder_(sensor.name(), FrameBuilder::Disorder::Skips, timings)
{
	segmentation_ = std::thread([this] { runThread(&LiveFrames::segmentAll, segmentationEnded_); });
	tracking_ = std::thread([this] { runThread(&LiveFrames::trackAll, trackingEnded_); });
}

LiveFrames::~LiveFrames()
{
	{
		const std::lock_guard lock(mutex_);
		stopped_ = true;
		changed_.notify_all();
	}
	sensor_.stop();
	tracking_.join();
	segmentation_.join();
}

void LiveFrames::runThread(void (LiveFrames::*body)(), bool& ended)
{
	std::exception_ptr failure;
	try
	{
		(this->*body)();
	}
	catch (...)
	{
		failure = std::current_exception();
	}
	const std::lock_guard lock(mutex_);
	// Moved: the last to hold the exception must be the consumer, who may still read it.
	if (failure && !error_) error_ = std::move(failure);
	ended = true;
	changed_.notify_all();
}

void LiveFrames::trackAll()
{
	const auto isWanted = [&]
	{
		const std::lock_guard lock(mutex_);
		return !stopped_ && !segmentationEnded_;
	};
	while (const auto observation = sensor_.next())
	{
		if (!isWanted()) return;
		auto frame = builder_.take(observation);
		keepSkipped(builder_.takeSkipped());
		if (frame) trackFrame(std::move(*frame));
	}
}

void LiveFrames::trackFrame(SlamFrame frame)
{
	Waiting waiting;
	waiting.raw = frame.rgbd;
	{
		const StageTimings::Scope timing(timings_, "rectify");
		frame.rgbd = imageRectifier_.rectify(frame.rgbd);
	}
	waiting.tracked.odometry = slam_.track(frame);
	waiting.tracked.frame = std::move(frame);

	const std::lock_guard lock(mutex_);
	waiting.hasImages = toSegment_.size() < std::size_t(options_.segmentationQueue) &&
						readyWithImages() < std::size_t(options_.mappingQueue);
	if (!waiting.hasImages)
	{
		++unsegmented_;
		waiting.isReady = true;
		waiting.raw = {};
		RgbdFrame& images = waiting.tracked.frame.rgbd;
		images.color.release();
		images.depth.release();
		waiting.tracked.frame.scan.reset();
	}
	waiting_.push_back(std::move(waiting));
	if (waiting_.back().hasImages) toSegment_.push_back(&waiting_.back());
	changed_.notify_all();
}

std::size_t LiveFrames::readyWithImages() const
{
	return std::size_t(std::count_if(
		waiting_.begin(), waiting_.end(),
		[](const Waiting& frame) { return frame.isReady && frame.hasImages; }));
}

void LiveFrames::segmentAll()
{
	while (true)
	{
		Waiting* frame = nullptr;
		{
			std::unique_lock lock(mutex_);
			changed_.wait(lock, [&] { return !toSegment_.empty() || trackingEnded_ || stopped_; });
			if (toSegment_.empty() || stopped_) return;
			frame = toSegment_.front();
		}
		segmentNext(*frame);
	}
}

void LiveFrames::segmentNext(Waiting& frame)
{
	CObservationInstances::Ptr instances;
	{
		const StageTimings::Scope timing(timings_, "segmentation");
		instances = frontEnd_.instancesOf(frame.raw);
		if (instances) instances = maskRectifier_.rectify(*instances);
	}
	const std::lock_guard lock(mutex_);
	toSegment_.pop_front();
	frame.tracked.frame.instances = std::move(instances);
	frame.raw = {};
	frame.isReady = true;
	changed_.notify_all();
}

std::optional<TrackedFrame> LiveFrames::next(std::chrono::milliseconds patience)
{
	std::unique_lock lock(mutex_);
	const auto isReady = [&] { return !waiting_.empty() && waiting_.front().isReady; };
	changed_.wait_for(lock, patience, [&] { return isReady() || isOver(); });
	if (isReady())
	{
		TrackedFrame result = std::move(waiting_.front().tracked);
		waiting_.pop_front();
		return result;
	}
	if (isOver() && error_) std::rethrow_exception(std::exchange(error_, nullptr));
	return std::nullopt;
}

bool LiveFrames::hasEnded() const
{
	const std::lock_guard lock(mutex_);
	// An error is still to be thrown.
	return trackingEnded_ && segmentationEnded_ && waiting_.empty() && !error_;
}

void LiveFrames::keepSkipped(std::vector<std::string> warnings)
{
	const std::lock_guard lock(mutex_);
	skipped_.insert(skipped_.end(), warnings.begin(), warnings.end());
}

std::vector<std::string> LiveFrames::takeSkipped()
{
	const std::lock_guard lock(mutex_);
	return std::exchange(skipped_, {});
}

std::size_t LiveFrames::unsegmented() const
{
	const std::lock_guard lock(mutex_);
	return unsegmented_;
}

}  // namespace semloop
