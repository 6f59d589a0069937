#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/SensorRecorder.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace semloop
{
namespace
{
constexpr std::size_t kFrames = 100, kOthers = 10000;  // that may wait
constexpr std::size_t kCompressed = 10;  // so many waiting frames leave time for compression

bool isFrame(const mrpt::obs::CObservation& observation)
{
	return dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation) != nullptr;
}
}  // namespace

struct SensorRecorder::State
{
	State(const std::string& file, Report itsReport)
		: path(file), report(std::move(itsReport)), writer(file)
	{
	}

	const std::string path;
	const Report report;
	std::optional<RawlogWriter> writer;  //!< the thread's, while that runs
	mutable std::mutex mutex;
	std::condition_variable changed;
	std::deque<mrpt::obs::CObservation::Ptr> queue;
	std::size_t frames = 0;  //!< in the queue
	Counts counts;
	bool closing = false;
	std::exception_ptr error;
	std::thread thread;

	/** The next one; null when all is written. */
	mrpt::obs::CObservation::Ptr take()
	{
		std::unique_lock lock(mutex);
		changed.wait(lock, [&] { return !queue.empty() || closing; });
		if (queue.empty()) return nullptr;
		writer->setCompression(frames <= kCompressed);
		const auto observation = queue.front();
		queue.pop_front();
		if (isFrame(*observation)) --frames;
		return observation;
	}

	void run()
	{
		try
		{
			while (const auto observation = take())
			{
				writer->write(*observation);
				const std::lock_guard lock(mutex);
				++counts.recorded;
			}
		}
		catch (const std::exception& e)
		{
			fail(exceptionMessage(e));
		}
	}

	void fail(const std::string& why)
	{
		// What was written before stands in the partial file, and says so itself.
		const bool named = why.rfind(path, 0) == 0;
		const std::string text = named ? why : path + ": " + why;
		report("the recording ends here: " + text);
		const std::lock_guard lock(mutex);
		error = std::make_exception_ptr(InputError(text));
		counts.omitted += 1 + queue.size();
		queue.clear();
		closing = true;
	}
};

SensorRecorder::SensorRecorder(const std::string& path, Report report)
	: state_(std::make_unique<State>(path, std::move(report)))
{
	state_->thread = std::thread([state = state_.get()] { state->run(); });
}

SensorRecorder::~SensorRecorder()
{
	endThread();
	state_->writer.reset();
	std::error_code ignored;
	if (state_->counts.recorded == 0)
		std::filesystem::remove(RawlogWriter::partialPath(state_->path), ignored);
}

void SensorRecorder::endThread()
{
	{
		const std::lock_guard lock(state_->mutex);
		state_->closing = true;
		state_->changed.notify_all();
	}
	if (state_->thread.joinable()) state_->thread.join();
}

void SensorRecorder::write(const mrpt::obs::CObservation::Ptr& observation)
{
	bool isFirstOmitted = false;
	{
		const std::lock_guard lock(state_->mutex);
		const bool hasRoom = state_->frames < kFrames && state_->queue.size() < kOthers;
		if (hasRoom && !state_->closing)
		{
			state_->queue.push_back(observation);
			if (isFrame(*observation)) ++state_->frames;
			state_->changed.notify_all();
			return;
		}
		isFirstOmitted = state_->counts.omitted++ == 0 && !state_->closing;
	}
	if (isFirstOmitted)
		state_->report(
			state_->path + ": the disk does not keep up; what it has no time for is not recorded");
}

void SensorRecorder::close()
{
	endThread();
	if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
	if (state_->counts.recorded > 0 && state_->writer) state_->writer->close();
}

SensorRecorder::Counts SensorRecorder::counts() const
{
	const std::lock_guard lock(state_->mutex);
	return state_->counts;
}

}  // namespace semloop
