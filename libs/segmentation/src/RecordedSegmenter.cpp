#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/RecordedSegmenter.h>

#include <chrono>
#include <filesystem>
#include <utility>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(RecordedSegmenter, Segmenter, semloop)

namespace
{
MRPT_INITIALIZER(registerRecordedSegmenter)
{
	mrpt::rtti::registerClass(CLASS_ID(RecordedSegmenter));
}

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::string text(mrpt::Clock::time_point time)
{
	return std::to_string(mrpt::Clock::toDouble(time)) + " s";
}
}  // namespace

void RecordedSegmenterOptions::describe(OptionFields& fields)
{
	fields.text("file", file, "rawlog with the instances, as rawlog-segment writes it");
	fields.number(
		"max_time_difference", maxTimeDifference, 0, 1,
		"of a frame and its instances [s]; a camera that plays a recording needs half a frame's "
		"time");
}

void RecordedSegmenter::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	RecordedSegmenterOptions options;
	options.loadFromConfigFile(config, section);
	if (options.file.empty())
		throw UsageError(
			configFileName(config) + ": [" + section +
			"] file: missing; name the rawlog that rawlog-segment wrote");
	configure(options);
}

void RecordedSegmenter::configure(const RecordedSegmenterOptions& options)
{
	if (!std::filesystem::exists(options.file))
		throw InputError(
			options.file +
			": no such file; make it with rawlog-segment, or name another rawlog with "
			"instances");
	reader_ = std::make_unique<RawlogReader>(options.file);
	tolerance_ = std::chrono::duration_cast<mrpt::Clock::duration>(
		std::chrono::duration<double>(options.maxTimeDifference));
	next_.reset();
	lastRead_.reset();
	lastFrame_.reset();
}

CObservationInstances::Ptr RecordedSegmenter::readNext()
{
	while (const auto observation = reader_->next())
	{
		const auto instances = std::dynamic_pointer_cast<CObservationInstances>(observation);
		if (!instances) continue;
		const std::string place = reader_->name() + ": instances at " + text(instances->timestamp);
		if (lastRead_ && instances->timestamp < *lastRead_)
			throw InputError(
				place + " come after those at " + text(*lastRead_) + "; run rawlog-segment again");
		lastRead_ = instances->timestamp;
		try
		{
			instances->validate();
		}
		catch (const InputError& e)
		{
			throw InputError(place + ": " + e.what());
		}
		return instances;
	}
	return nullptr;
}

CObservationInstances::Ptr RecordedSegmenter::segment(const RgbdFrame& frame)
{
	if (!reader_) throw UsageError("RecordedSegmenter: configure() was not called");
	if (lastFrame_ && frame.time < *lastFrame_)
		throw InputError(
			reader_->name() + ": asked for the frame at " + text(frame.time) + " after that at " +
			text(*lastFrame_) + "; recorded instances are read in order of time");
	lastFrame_ = frame.time;

	while (!next_ || next_->timestamp < frame.time - tolerance_)
		if (!(next_ = readNext())) return nullptr;
	if (next_->timestamp > frame.time + tolerance_) return nullptr;
	if (next_->imageSize() != frame.color.size())
		throw InputError(
			reader_->name() + ": instances at " + text(next_->timestamp) + " are of an image of " +
			text(next_->imageSize()) + ", but the frame's is " + text(frame.color.size()) +
			"; make them from this rawlog with rawlog-segment");
	next_->timestamp = frame.time;
	return std::exchange(next_, nullptr);
}

}  // namespace semloop
