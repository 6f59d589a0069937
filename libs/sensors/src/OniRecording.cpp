#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/sensors/OniRecording.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "OniPlayer.h"

namespace semloop
{
namespace
{
constexpr std::size_t kLongestQueue = 60;  // images of one kind without any of the other

/** Images of one kind that wait for their partners. */
struct Queue
{
	std::deque<OniImage> images;
	std::size_t unpaired = 0;

	void dropFirst()
	{
		images.pop_front();
		++unpaired;
	}
};

}  // namespace

struct OniRecording::Impl
{
	Impl(const std::string& path, const OniReading& itsReading)
		: player(path, itsReading.keepMirrored), reading(itsReading)
	{
	}

	/** Reads until both kinds have their next two images, as far as there are any. */
	bool readAhead()
	{
		while (std::min(depths.images.size(), colors.images.size()) < 2)
		{
			auto image = player.next();
			if (!image) break;
			Queue& queue = image->isDepth ? depths : colors;
			queue.images.push_back(std::move(*image));
			if (queue.images.size() > kLongestQueue) queue.dropFirst();
		}
		return !depths.images.empty() && !colors.images.empty();
	}

	std::optional<OniFrame> nextPair()
	{
		while (readAhead())
		{
			const OniImage& d = depths.images.front();
			const OniImage& c = colors.images.front();
			Queue& earlier = d.time <= c.time ? depths : colors;
			const auto gap = std::chrono::abs(d.time - c.time);
			const auto later = std::max(d.time, c.time);
			const bool successorIsNearer =
				earlier.images.size() > 1 && std::chrono::abs(earlier.images[1].time - later) < gap;
			if (reading.greedyWithin ? gap <= *reading.greedyWithin
									 : gap <= player.period() / 2 && !successorIsNearer)
			{
				OniFrame frame{d.time, c.pixels, d.pixels};
				depths.images.pop_front();
				colors.images.pop_front();
				return frame;
			}
			earlier.dropFirst();
		}
		for (Queue* queue : {&depths, &colors})
			while (!queue->images.empty()) queue->dropFirst();
		return std::nullopt;
	}

	OniPlayer player;
	const OniReading reading;
	Queue depths, colors;
};

OniRecording::OniRecording(const std::string& path, const OniReading& reading)
	: impl_(std::make_unique<Impl>(path, reading))
{
}
OniRecording::~OniRecording() = default;
OniRecording::OniRecording(OniRecording&&) noexcept = default;
OniRecording& OniRecording::operator=(OniRecording&&) noexcept = default;

std::optional<OniFrame> OniRecording::next()
{
	return impl_->nextPair();
}

const std::string& OniRecording::path() const
{
	return impl_->player.path();
}

cv::Size OniRecording::size() const
{
	return impl_->player.size();
}

float OniRecording::depthUnit() const
{
	return impl_->player.depthUnit();
}

mrpt::img::TCamera OniRecording::camera() const
{
	const cv::Vec2d fieldOfView = impl_->player.fieldOfView();
	const double horizontal = fieldOfView[0], vertical = fieldOfView[1];
	if (!(horizontal > 0 && horizontal < M_PI && vertical > 0 && vertical < M_PI))
		throw InputError(
			path() +
			": does not tell the camera's field of view: give a file with the "
			"camera's intrinsics");
	const cv::Size size = impl_->player.size();
	mrpt::img::TCamera camera;
	camera.ncols = uint32_t(size.width);
	camera.nrows = uint32_t(size.height);
	camera.setIntrinsicParamsFromValues(
		size.width / (2 * std::tan(horizontal / 2)), size.height / (2 * std::tan(vertical / 2)),
		0.5 * (size.width - 1), 0.5 * (size.height - 1));
	return camera;
}

std::size_t OniRecording::unpairedColor() const
{
	return impl_->colors.unpaired;
}

std::size_t OniRecording::unpairedDepth() const
{
	return impl_->depths.unpaired;
}

double OniRecording::progress() const
{
	return impl_->player.progress();
}

OniScans::OniScans(
	OniRecording recording, const std::optional<mrpt::img::TCamera>& camera,
	mrpt::Clock::time_point start)
	: recording_(std::move(recording)),
	  camera_(camera ? *camera : recording_.camera()),
	  start_(start)
{
	const cv::Size size = recording_.size(), ofCamera(int(camera_.ncols), int(camera_.nrows));
	if (size == ofCamera) return;
	const std::string sizes = mrpt::format(
		"images of %dx%d pixels where the camera has %dx%d", size.width, size.height,
		ofCamera.width, ofCamera.height);
	throw InputError(
		recording_.path() + ": " + sizes +
		": give the right one (--camera, or camera_file of COniFileSensor)");
}

mrpt::obs::CObservation3DRangeScan::Ptr OniScans::next()
{
	const auto frame = recording_.next();
	if (!frame && !firstTime_)
		throw InputError(
			recording_.path() +
			": no colour and depth image in it were taken together: record it again");
	if (!frame) return nullptr;
	if (!firstTime_) firstTime_ = frame->time;
	auto scan = rangeScanFrom(frame->color, frame->depth, recording_.depthUnit(), camera_);
	scan->timestamp =
		start_ + std::chrono::duration_cast<mrpt::Clock::duration>(frame->time - *firstTime_);
	return scan;
}

}  // namespace semloop
