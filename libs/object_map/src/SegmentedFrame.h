#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>

#include <vector>

namespace semloop
{
/** A rectified frame and what was found in it. */
struct SegmentedFrame
{
	RgbdFrame frame;
	std::vector<Instance> instances;

	/** Depth is known inside the instances' crops only, and there is one colour a label. Throws as
	 *  CObservationInstances::validate(). */
	static SegmentedFrame fromCrops(const CObservationInstances& observation);
	/** Of the scan that the instances were found in. Throws as rgbdFrameFrom() and validate(), and
	 *  InputError when the images are of different sizes. */
	static SegmentedFrame fromScan(
		const mrpt::obs::CObservation3DRangeScan& scan, const CObservationInstances& observation);
};

}  // namespace semloop
