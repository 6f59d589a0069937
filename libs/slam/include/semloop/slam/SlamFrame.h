#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>

#include <vector>

namespace semloop
{
/** One frame, ready for mapping: images and masks rectified. */
struct SlamFrame
{
	RgbdFrame rgbd;
	CObservationInstances::Ptr instances;              //!< null: this frame was not segmented
	mrpt::obs::CObservation3DRangeScan::Ptr scan;      //!< as recorded
	std::vector<mrpt::obs::CObservation::Ptr> before;  //!< other observations since the last frame
	double progress = 0.0;                             //!< share of the rawlog read so far
};

}  // namespace semloop
