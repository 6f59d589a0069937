#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/slam/FrameBuilder.h>

#include <utility>

using mrpt::obs::CObservation3DRangeScan;

namespace semloop
{
FrameBuilder::FrameBuilder(std::string source, Disorder disorder, StageTimings& timings)
	: source_(std::move(source)), disorder_(disorder), timings_(timings)
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
	if (!isInOrder(*scan)) return std::nullopt;
	auto images = imagesOf(*scan);
	if (!images) return std::nullopt;
	SlamFrame frame;
	frame.rgbd = std::move(*images);
	frame.scan = scan;
	frame.before = std::exchange(others_, {});
	return frame;
}

std::vector<std::string> FrameBuilder::takeSkipped()
{
	return std::exchange(skipped_, {});
}

bool FrameBuilder::isInOrder(const CObservation3DRangeScan& scan)
{
	if (!lastTime_ || scan.timestamp > *lastTime_)
	{
		lastTime_ = scan.timestamp;
		return true;
	}
	const std::string frame = source_ + ": frame at " + formatUnixTime(scan.timestamp),
					  before = "the frame before is of " + formatUnixTime(*lastTime_);
	if (disorder_ == Disorder::Throws)
		throw InputError(
			frame + ": time goes backwards (" + before + "); sort the rawlog by time first");
	skipped_.push_back(frame + " skipped: " + before);
	return false;
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
