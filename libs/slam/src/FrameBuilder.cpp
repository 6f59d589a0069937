#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/slam/FrameBuilder.h>

#include <utility>

using mrpt::obs::CObservation3DRangeScan;

namespace semloop
{
FrameBuilder::FrameBuilder(std::string source, StageTimings& timings)
	: source_(std::move(source)), timings_(timings)
{
}

std::optional<SlamFrame> FrameBuilder::take(const mrpt::obs::CObservation::Ptr& observation)
{
	const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation);
	if (!scan)
	{
		others_.push_back(observation);
		return std::nullopt;
	}
	checkTime(*scan);
	auto images = imagesOf(*scan);
	if (!images) return std::nullopt;
	SlamFrame frame;
	frame.rgbd = std::move(*images);
	frame.scan = scan;
	frame.before = std::exchange(others_, {});
	frame.skipped = std::exchange(skipped_, {});
	return frame;
}

void FrameBuilder::checkTime(const CObservation3DRangeScan& scan)
{
	if (lastTime_ && scan.timestamp <= *lastTime_)
		throw InputError(
			source_ + ": frame at " + formatUnixTime(scan.timestamp) +
			": time goes backwards (the frame before is of " + formatUnixTime(*lastTime_) +
			"); sort the rawlog by time first");
	lastTime_ = scan.timestamp;
}

std::optional<RgbdFrame> FrameBuilder::imagesOf(const CObservation3DRangeScan& scan)
{
	try
	{
		const StageTimings::Scope timing(timings_, "read");
		RgbdFrame frame = rgbdFrameFrom(scan);
		if (countValidDepth(frame) == 0) throw InputError("no pixel has a valid depth");
		return frame;
	}
	catch (const std::exception& e)
	{
		skipped_.push_back(
			source_ + ": frame at " + formatUnixTime(scan.timestamp) +
			" skipped: " + exceptionMessage(e));
		return std::nullopt;
	}
}

}  // namespace semloop
