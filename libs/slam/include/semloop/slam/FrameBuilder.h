#pragma once

#include <semloop/slam/SlamFrame.h>
#include <semloop/slam/StageTimings.h>

#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** Makes frames of observations, one observation after the other.
 *
 *  A frame that cannot be used (image missing or unreadable, sizes that do not fit, no valid depth)
 *  is skipped and told by takeSkipped(). */
class FrameBuilder
{
public:
	/** What to do with a frame that is not later than the one before. */
	enum class Disorder
	{
		Throws,  //!< a rawlog is to be sorted
		Skips    //!< as one that cannot be used; a sensor goes on
	};

	/** The source's name is for messages. */
	FrameBuilder(std::string source, Disorder disorder, StageTimings& timings);

	/** A frame, neither segmented nor rectified, when the observation is an RGB-D scan that can be
	 *  used. Throws InputError when time goes backwards and Disorder says so. */
	std::optional<SlamFrame> take(const mrpt::obs::CObservation::Ptr& observation);
	/** Warnings about frames that could not be used, since the last call. */
	std::vector<std::string> takeSkipped();

private:
	/** False: to be skipped. */
	bool isInOrder(const mrpt::obs::CObservation3DRangeScan& scan);
	/** Empty: the frame is to be skipped; why is in skipped_. */
	std::optional<RgbdFrame> imagesOf(const mrpt::obs::CObservation3DRangeScan& scan);

	std::string source_;
	Disorder disorder_;
	StageTimings& timings_;
	std::vector<mrpt::obs::CObservation::Ptr> others_;
	std::vector<std::string> skipped_;
	std::optional<mrpt::Clock::time_point> lastTime_;
};

}  // namespace semloop
