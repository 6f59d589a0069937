#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/SensorRecorder.h>

#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "ObservationQueue.h"

namespace semloop
{
namespace
{
constexpr std::size_t kFrames = 100;     // that may wait
constexpr std::size_t kCompressed = 10;  // so many waiting frames leave time for compression

struct Task
{
	mrpt::obs::CObservation::Ptr observation;
	bool compress = true;
};
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
	ObservationQueue queue{kFrames};
	Counts counts;
	bool closing = false;
	std::exception_ptr error;
	std::thread thread;

	/** The next one; none when all is written. */
	std::optional<Task> take()
	{
		std::unique_lock lock(mutex);
		changed.wait(lock, [&] { return !queue.isEmpty() || closing; });
		if (queue.isEmpty()) return std::nullopt;
		const bool compress = queue.frames() <= kCompressed;
		return Task{queue.pop(), compress};
	}

	void run()
	{
		try
		{
			while (const auto task = take())
			{
				// May wait for the disk as writing does, so neither is done with the lock.
				writer->setCompression(task->compress);
				writer->write(*task->observation);
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
		++counts.omitted;
		while (queue.pop()) ++counts.omitted;
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
		if (!state_->queue.isFullFor(*observation) && !state_->closing)
		{
			state_->queue.push(observation);
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
