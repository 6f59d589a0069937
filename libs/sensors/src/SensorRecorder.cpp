#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/SensorRecorder.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace semloop
{
namespace
{
constexpr std::size_t kCapacity = 30;
}

struct SensorRecorder::State
{
	explicit State(const std::string& path) : writer(path) {}

	RawlogWriter writer;  //!< the thread's, while that runs
	std::mutex mutex;
	std::condition_variable changed;
	std::deque<mrpt::obs::CObservation::Ptr> queue;
	bool closing = false;
	std::exception_ptr error;
	std::thread thread;

	/** The next one; null when all is written. */
	mrpt::obs::CObservation::Ptr take()
	{
		std::unique_lock lock(mutex);
		changed.wait(lock, [&] { return !queue.empty() || closing; });
		if (queue.empty()) return nullptr;
		const auto observation = queue.front();
		queue.pop_front();
		changed.notify_all();
		return observation;
	}

	void run()
	{
		try
		{
			while (const auto observation = take()) writer.write(*observation);
		}
		catch (...)
		{
			const std::lock_guard lock(mutex);
			error = std::current_exception();
			closing = true;
			changed.notify_all();
		}
	}
};

SensorRecorder::SensorRecorder(const std::string& path) : state_(std::make_unique<State>(path))
{
	state_->thread = std::thread([state = state_.get()] { state->run(); });
}

SensorRecorder::~SensorRecorder()
{
	try
	{
		close();
	}
	catch (const std::exception&)
	{
	}
}

void SensorRecorder::write(const mrpt::obs::CObservation::Ptr& observation)
{
	std::unique_lock lock(state_->mutex);
	state_->changed.wait(lock, [&] { return state_->queue.size() < kCapacity || state_->closing; });
	if (state_->closing) return;
	state_->queue.push_back(observation);
	state_->changed.notify_all();
}

void SensorRecorder::close()
{
	if (!state_->thread.joinable()) return;
	{
		const std::lock_guard lock(state_->mutex);
		state_->closing = true;
		state_->changed.notify_all();
	}
	state_->thread.join();
	if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
	state_->writer.close();
}

}  // namespace semloop
