#include "MappingLoop.h"

#include <mrpt/core/format.h>
#include <semloop/config/ExceptionMessage.h>

#include <chrono>
#include <exception>
#include <iostream>
#include <optional>
#include <utility>

#include "StopSignal.h"

namespace semloop
{
namespace
{
// How soon a live run notices Ctrl-C.
constexpr std::chrono::milliseconds kPatience{100};
constexpr std::size_t kMostWarnings = 100;
}  // namespace

const char* const kEndedByUser = "Ctrl-C";

void News::add(const std::string& line)
{
	const std::lock_guard lock(mutex_);
	lines_.push_back(line);
}

std::vector<std::string> News::take()
{
	const std::lock_guard lock(mutex_);
	return std::exchange(lines_, {});
}

std::string MappingLoop::run(FrameSource& recording)
{
	try
	{
		while (wantsMore() && mapNext(recording))
		{
		}
	}
	catch (const std::exception& e)
	{
		warn(recording.takeSkipped());
		return info_.endedBy = exceptionMessage(e);
	}
	return {};
}

bool MappingLoop::wantsMore()
{
	if (maxFrames_ > 0 && slam_.frameCount() >= maxFrames_)
		info_.endedBy = "--max-frames";
	else if (stopRequested())
		info_.endedBy = kEndedByUser;
	else
		return true;
	return false;
}

bool MappingLoop::mapNext(FrameSource& recording)
{
	const auto frame = recording.next();
	warn(recording.takeSkipped());
	if (!frame) return false;
	slam_.process(*frame);
	bar_.update(slam_.frameCount(), frame->progress);
	if (window_)
	{
		window_->show(*frame, slam_, timings_);
		window_->waitWhilePaused();
	}
	return true;
}

std::string MappingLoop::run(LiveFrames& frames, SensorSource& sensor, News& news)
{
	std::string failure;
	try
	{
		while (mapNext(frames, sensor, news))
		{
		}
	}
	catch (const std::exception& e)
	{
		failure = info_.endedBy = exceptionMessage(e);
	}
	warn(frames.takeSkipped());
	info_.live = countsOf(frames, sensor);
	return failure;
}

bool MappingLoop::mapNext(LiveFrames& frames, SensorSource& sensor, News& news)
{
	if (!wantsMore() && info_.endedBy != kEndedByUser) return false;
	if (stopRequested()) sensor.stop();  // what it has given is still to be mapped
	tell(news);
	warn(frames.takeSkipped());
	const auto tracked = frames.next(kPatience);
	if (tracked) slam_.integrate(tracked->frame, tracked->odometry);
	const LiveCounts counts = countsOf(frames, sensor);
	bar_.updateEndless(
		slam_.frameCount(),
		mrpt::format(
			", %zu dropped, %zu not segmented", counts.sensor.dropped, counts.unsegmented));
	if (window_)
	{
		const WindowNews shown{counts.sensor.dropped, sensorNews_};
		if (tracked)
		{
			window_->show(tracked->frame, slam_, timings_, shown);
			window_->waitWhilePaused();
		}
		else
			window_->show(slam_, timings_, shown);
	}
	return tracked || !frames.hasEnded();
}

void MappingLoop::tell(News& news)
{
	for (const std::string& line : news.take())
	{
		bar_.clear();
		std::cerr << "semloop-slam: " << line << "\n";
		sensorNews_ = line;
	}
}

LiveCounts MappingLoop::countsOf(const LiveFrames& frames, const SensorSource& sensor) const
{
	return {sensor.counts(), frames.unsegmented(), {}};
}

void MappingLoop::warn(const std::vector<std::string>& warnings)
{
	for (const auto& warning : warnings)
	{
		if (++info_.skippedFrames > kMostWarnings) continue;
		bar_.clear();
		std::cerr << "semloop-slam: warning: " << warning << "\n";
		info_.warnings.push_back(warning);
		if (info_.skippedFrames == kMostWarnings)
			std::cerr << "semloop-slam: further frames that are skipped are only counted\n";
	}
}

}  // namespace semloop
