#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/evaluation/PlyFile.h>
#include <semloop/evaluation/TrajectoryError.h>

#include <Eigen/Core>
#include <vector>

namespace semloop
{
/** Distance of every point to the nearest point of the surface's triangles [m], exact. Throws InputError
 *  when the surface has no triangle. */
std::vector<double> distancesToSurface(
	const std::vector<Eigen::Vector3d>& points, const Surface& surface);

/** Distance of every vertex of the estimate, carried into the true world, to the true surface: what was
 *  built is where it should be. That something is missing does not show: of most objects one side only
 *  was ever to be seen. */
std::vector<double> surfaceErrors(
	const Surface& estimate, const Surface& truth,
	const mrpt::poses::CPose3D& T_truth_estimate = {});

struct SurfaceError
{
	ErrorSummary distance;    //!< [m]
	double percentile95 = 0;  //!< nearest rank [m]; 0 for an empty set
};

SurfaceError summarizeSurfaceErrors(std::vector<double> distances);

}  // namespace semloop
