#pragma once

#include <semloop/config/Options.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/segmentation/Segmenter.h>

#include <memory>
#include <optional>
#include <string>

namespace semloop
{
struct RecordedSegmenterOptions : Options
{
	std::string file;
	double maxTimeDifference = 0.001;  //!< of frame and entry [s]

protected:
	void describe(OptionFields& fields) override;
};

/** Instances that were computed before, from a sidecar rawlog of rawlog-segment (or any rawlog with
 *  CObservationInstances; other observations in it are passed over). Read as a stream. */
class RecordedSegmenter : public Segmenter
{
	DEFINE_MRPT_OBJECT(RecordedSegmenter, semloop)

public:
	/** Throws UsageError when no file is named, InputError when it is missing. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void configure(const RecordedSegmenterOptions& options);

	/** The first entry whose time is the frame's within max_time_difference, with the frame's time. Frames come in order of time, each
	 *  at most once. Throws InputError, naming file and time, when the entry does not fit the frame's
	 *  image, is damaged, or time goes backwards in the file or from frame to frame. */
	CObservationInstances::Ptr segment(const RgbdFrame& frame) override;

private:
	CObservationInstances::Ptr readNext();

	std::unique_ptr<RawlogReader> reader_;
	mrpt::Clock::duration tolerance_{};
	CObservationInstances::Ptr next_;  //!< read, and not yet asked for
	std::optional<mrpt::Clock::time_point> lastRead_;
	std::optional<mrpt::Clock::time_point> lastFrame_;
};

}  // namespace semloop
