#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/object_map/AssociationRecord.h>
#include <semloop/observations/Trajectory.h>

#include <cstddef>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace semloop
{
/** A real object in an image. */
struct TrueBox
{
	uint32_t object = 0;     //!< Instance::trueObject
	cv::Rect box;            //!< [px]
	std::size_t pixels = 0;  //!< of the mask, see readTrueFrames()
};

/** What is really to be seen at a time. */
struct TrueFrame
{
	mrpt::Clock::time_point time;
	std::vector<TrueBox> boxes;
};

/** The instances with a true object in every CObservationInstances of a rawlog, by time. Throws
 *  InputError when the rawlog cannot be read or no instance in it has a true object.
 *  @param images the rawlog with the frames that the run saw: only pixels whose depth was measured
 *  count, and frames without a usable image of their time (within 1 ms) are left out. Empty: all pixels
 *  count. Throws InputError when the sizes differ. */
std::vector<TrueFrame> readTrueFrames(const std::string& rawlog, const std::string& images = {});

/** A frame that the run used and whose truth is known. */
struct RunFrame
{
	std::size_t frame = 0;  //!< camera node, i.e. number of the pose in trajectory.tum
	std::vector<TrueBox> truth;
	std::vector<AssociationRecord> estimate;
};

/** Puts truth and result of one rawlog together: their times differ by rounding only, at most 1 ms.
 *  What the run did not get to see (before its start, behind its end, skipped) and what has no truth
 *  is left out. In order of time. Throws InputError when no frame is left. */
std::vector<RunFrame> joinWithTruth(
	const Trajectory& run, const std::vector<AssociationRecord>& associations,
	const std::vector<TrueFrame>& truth);

}  // namespace semloop
