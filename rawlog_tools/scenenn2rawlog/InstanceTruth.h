#pragma once

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/observations/CObservationInstances.h>

#include <cstddef>
#include <vector>

#include "AnnotatedMesh.h"

namespace semloop
{
/** Says which annotated object every pixel shows. The pixel (u, v) with depth z is the point
 *
 *      p_world = T_world_camera (z (u - cx) / fx, z (v - cy) / fy, z)
 *
 *  and belongs to the object of the mesh's nearest vertex, if that is at most `tolerance` away. Pixels
 *  without depth, off the mesh or nearest to a vertex of no object belong to none. */
class InstanceTruth
{
public:
	/** @param tolerance [m] */
	InstanceTruth(AnnotatedMesh mesh, double tolerance);

	/** The objects in a frame, with trueObject and certain of their labels, by id. The scan has its depth
	 *  inside, and a camera without distortion. */
	CObservationInstances of(
		const mrpt::obs::CObservation3DRangeScan& scan, const mrpt::poses::CPose3D& T_world_camera);

	const AnnotatedMesh& mesh() const { return mesh_; }
	/** How many of the frames so far show each object. */
	const std::vector<int>& observations() const { return observations_; }
	/** Share of all valid depth pixels so far that lie on the mesh; 0 when there was none. */
	double shareOnMesh() const;

private:
	cv::Mat objectsOf(
		const mrpt::obs::CObservation3DRangeScan& scan,
		const mrpt::poses::CPose3D& T_world_camera) const;

	AnnotatedMesh mesh_;
	float squaredTolerance_;  //!< [m^2]
	mrpt::maps::CSimplePointsMap vertices_;
	LabelSet labels_;
	std::vector<uint32_t> labelOfObject_;
	std::vector<int> observations_;
	std::size_t validPixels_ = 0, pixelsOnMesh_ = 0;
};

}  // namespace semloop
