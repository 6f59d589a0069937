#include <semloop/config/Error.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/slam/FrameSource.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

namespace semloop
{
namespace
{
std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}
}  // namespace

/** Bounded hand-over between the reading thread and the consumer. */
class FrameSource::Queue
{
public:
	explicit Queue(std::size_t capacity) : capacity_(capacity) {}

	/** False when nobody wants more. */
	bool push(Step step)
	{
		std::unique_lock lock(mutex_);
		changed_.wait(lock, [&] { return steps_.size() < capacity_ || stopped_; });
		if (stopped_) return false;
		steps_.push_back(std::move(step));
		changed_.notify_all();
		return true;
	}
	void finish(Step last)
	{
		const std::lock_guard lock(mutex_);
		finished_ = true;
		last_ = std::move(last);
		changed_.notify_all();
	}
	void stop()
	{
		const std::lock_guard lock(mutex_);
		stopped_ = true;
		changed_.notify_all();
	}
	Step pop()
	{
		std::unique_lock lock(mutex_);
		changed_.wait(lock, [&] { return !steps_.empty() || finished_; });
		if (steps_.empty()) return std::exchange(last_, {});
		Step step = std::move(steps_.front());
		steps_.pop_front();
		changed_.notify_all();
		return step;
	}

private:
	const std::size_t capacity_;
	std::mutex mutex_;
	std::condition_variable changed_;
	std::deque<Step> steps_;
	bool finished_ = false;
	bool stopped_ = false;
	Step last_;
};

FrameSource::FrameSource(
	std::unique_ptr<ObservationSource> recording, FrontEnd frontEnd, int framesAhead,
	StageTimings& timings)
	: recording_(std::move(recording)),
	  frontEnd_(std::move(frontEnd)),
	  timings_(timings),
	  builder_(recording_->name(), FrameBuilder::Disorder::Throws, timings)
{
	if (framesAhead == 0) return;
	queue_ = std::make_unique<Queue>(std::size_t(framesAhead));
	thread_ = std::thread(
		[this]
		{
			Step next = step();
			while (next.frame)
			{
				if (!queue_->push(std::move(next))) return;
				next = step();
			}
			// Moved: the last to hold the exception must be the consumer, who may still read it.
			queue_->finish(std::move(next));
		});
}

FrameSource::~FrameSource()
{
	if (queue_) queue_->stop();
	if (thread_.joinable()) thread_.join();
}

std::optional<SlamFrame> FrameSource::next()
{
	Step next = queue_ ? queue_->pop() : step();
	skipped_.insert(skipped_.end(), next.skipped.begin(), next.skipped.end());
	if (next.error) std::rethrow_exception(std::move(next.error));
	return std::move(next.frame);
}

std::vector<std::string> FrameSource::takeSkipped()
{
	return std::exchange(skipped_, {});
}

FrameSource::Step FrameSource::step()
{
	Step result;
	try
	{
		result.frame = produce();
	}
	catch (...)
	{
		result.error = std::current_exception();
	}
	result.skipped = builder_.takeSkipped();
	return result;
}

mrpt::obs::CObservation::Ptr FrameSource::read()
{
	if (readError_) std::rethrow_exception(std::exchange(readError_, nullptr));
	return lookAhead_ ? std::exchange(lookAhead_, nullptr) : recording_->next();
}

void FrameSource::lookAhead()
{
	try
	{
		lookAhead_ = recording_->next();
	}
	catch (...)
	{
		// The frame at hand is good: the error waits for its turn.
		readError_ = std::current_exception();
	}
}

std::optional<SlamFrame> FrameSource::produce()
{
	while (const auto observation = read())
	{
		auto frame = builder_.take(observation);
		if (!frame) continue;
		segment(*frame);
		const StageTimings::Scope timing(timings_, "rectify");
		frame->rgbd = rectifier_.rectify(frame->rgbd);
		if (frame->instances) frame->instances = rectifier_.rectify(*frame->instances);
		frame->progress = recording_->progress();
		return frame;
	}
	return std::nullopt;
}

void FrameSource::requireSize(const CObservationInstances& recorded, const RgbdFrame& raw) const
{
	const cv::Size wanted = raw.color.size(), size = recorded.imageSize();
	if (size == wanted) return;
	throw InputError(
		recording_->name() + ": instances at " + formatUnixTime(recorded.timestamp) +
		" are of an image of " + text(size) + ", but the frame's is " + text(wanted) +
		"; make them from this rawlog with rawlog-segment");
}

void FrameSource::segment(SlamFrame& frame)
{
	const StageTimings::Scope timing(timings_, "segmentation");
	// A rawlog into which the instances were merged has them right behind their scan.
	lookAhead();
	const auto recorded = std::dynamic_pointer_cast<CObservationInstances>(lookAhead_);
	if (recorded && recorded->timestamp == frame.rgbd.time)
	{
		lookAhead_.reset();
		requireSize(*recorded, frame.rgbd);
		frame.instances = recorded;
		frontEnd_.embed(frame.rgbd, *recorded);
	}
	else
		frame.instances = frontEnd_.instancesOf(frame.rgbd);
}

}  // namespace semloop
