#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "AlignmentImage.h"

namespace semloop
{
struct DirectAlignmentOptions
{
	int iterations = 10;       //!< 0: only the normal equations at the start
	double depthWeight = 0.1;  //!< of the depth residuals' share against the brightness residuals'
	double maxDepthDifference = 0.07;  //!< larger: another surface [m]
};

struct DirectAlignmentResult
{
	bool valid = false;  //!< false: too few points seen, or a singular system
	Eigen::Isometry3d T_current_reference = Eigen::Isometry3d::Identity();
	/** J^T W J at the solution, of a motion e of the current camera,
	 *  T_current_reference = exp(e) * estimate, translation first. */
	Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
	double overlap = 0;  //!< share of the points that are seen again, in [0, 1]
	int iterations = 0;
};

/** Dense alignment as in DVO (Kerl, Sturm, Cremers: Robust odometry estimation for RGB-D cameras,
 *  ICRA 2013, and Dense visual SLAM for RGB-D cameras, IROS 2013), by iteratively reweighted
 *  Gauss-Newton at full resolution, so that it needs a start within a few pixels. With q = T p, its pixel u,
 *
 *      r_I = I(u) - (a I_reference + b)      a, b: exposure, estimated along and marginalised
 *      r_Z = (Z(u) - q_z) / sigma_z(q_z)     linearised by the surface's slope, i.e. point to plane
 *
 *  both weighted by a Student t distribution (5 degrees of freedom) whose scale is estimated.
 *  sigma_z = 0.0012 + 0.0019 (z - 0.4)^2 (Nguyen, Izadi, Lovell: 3DIMPVT 2012). */
DirectAlignmentResult alignDirectly(
	const std::vector<AlignmentPoint>& points, const AlignmentImage& current,
	const Eigen::Isometry3d& T_current_reference, const DirectAlignmentOptions& options);

}  // namespace semloop
