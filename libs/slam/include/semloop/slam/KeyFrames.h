#pragma once

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <cstddef>
#include <vector>

namespace semloop
{
/** A frame with its images; its pose is that of its camera node. */
struct KeyFrame
{
	std::size_t frame = 0;
	mrpt::obs::CObservation3DRangeScan::Ptr scan;
	CObservationInstances::Ptr instances;
};

/** The frames kept for maps of MRPT: views that differ, so that memory grows with the space that was
 *  seen and not with time, and never beyond a number of them. */
class KeyFrames
{
public:
	/** distance [m], angle [rad]: a view that is nearer to one that is kept in both is left out.
	 *  most: when there are more, every other one is dropped, and distance and angle double. */
	KeyFrames(double distance, double angle, std::size_t most);

	void offer(const KeyFrame& frame, const PoseGraph& poses);
	const std::vector<KeyFrame>& all() const { return frames_; }  //!< in order of time

private:
	bool isCovered(const mrpt::poses::CPose3D& T_world_camera, const PoseGraph& poses) const;

	double distance_, angle_;
	std::size_t most_;
	std::vector<KeyFrame> frames_;
};

}  // namespace semloop
