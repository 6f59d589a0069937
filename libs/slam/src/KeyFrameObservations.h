#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/slam/SemanticSlam.h>

namespace semloop
{
/** A key frame as maps of MRPT take it. */
struct KeyFrameObservations
{
	/** Optimised, and level, for grid maps refuse scans that are tilted against the robot: a tilt is in the
	 *  sensors' poses. */
	mrpt::poses::CPose3D T_world_robot;
	/** In this order: the range scan, its images inside and its points unprojected, at most 20 000 of
	 *  them and none further than the objects' measurements; a horizontal CObservation2DRangeScan for maps
	 *  that take no points; the instances. */
	mrpt::obs::CSensoryFrame::Ptr frame;
};

/** Throws InputError when an external image of the scan cannot be read. */
KeyFrameObservations keyFrameObservations(const SemanticSlam& slam, const KeyFrame& key);

/** Takes the depth beyond maxDepth [m] out of the image; its points stay. */
void cutDepth(mrpt::obs::CObservation3DRangeScan& scan, double maxDepth);

}  // namespace semloop
