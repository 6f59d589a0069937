#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/object_map/Object.h>

#include <cstddef>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace semloop
{
/** A detection that is an object of the map: a line of associations.csv. */
struct AssociationRecord
{
	mrpt::Clock::time_point time;
	std::size_t frame = 0;     //!< camera node
	std::size_t instance = 0;  //!< index in the frame's (rectified) CObservationInstances
	cv::Rect box;              //!< of the detection [px]
	ObjectId object = 0;       //!< what its object has become by all merges
	ObjectId firstObject = 0;  //!< that it was associated with
};

/** associations.csv: a heading, then a line a record, in their order. */
std::string associationsAsCsv(const std::vector<AssociationRecord>& associations);
/** Throws InputError, naming file and line, for a missing file and for what associationsAsCsv() would
 *  not write. */
std::vector<AssociationRecord> readAssociations(const std::string& path);

}  // namespace semloop
