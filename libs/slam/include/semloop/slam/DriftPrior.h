#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/loop_closure/PosePrior.h>
#include <semloop/odometry/Odometry.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <cstddef>
#include <vector>

namespace semloop
{
/** What odometry claims about a loop closure: the camera moved from there to here, and drifted no more
 *  than its covariance says. */
class DriftPrior
{
public:
	/** The next frame, the first included. */
	void add(const OdometryEstimate& odometry);

	/** Covariance of T_a_b of two frames, a <= b, about b: T_a_b exp(d), order (rho [m], phi [rad]).
	 *  P_ac = Ad(T_b_c^-1) P_ab Ad(T_b_c^-1)^T + P_bc makes those of the first frame, and from them any. */
	Matrix6 covariance(std::size_t a, std::size_t b) const;

	/** How far a correction is from what odometry expects, which is none: sqrt(e^T S^-1 e) of
	 *  e = (displacement of the point, change of heading), S the drift's covariance between the frames
	 *  carried to the point, plus that of the loop closure itself. In standard deviations.
	 *  @param T_world_camera of frame b, as the odometry has it
	 *  @param T_target_query the correction, and the point [m] it is judged at: the query's centroid */
	double sigmas(
		std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
		const mrpt::poses::CPose3D& T_target_query, const mrpt::math::TPoint3D& point) const;

	/** The same as a loop detector's prior: no correction, with the standard deviations of S; of the
	 *  horizontal directions the larger one. Parameters as of sigmas(). */
	PosePrior prior(
		std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
		const mrpt::math::TPoint3D& point) const;

private:
	/** S: of x, y, z [m] and yaw [rad]. */
	Eigen::Matrix4d covarianceAt(
		std::size_t a, std::size_t b, const mrpt::poses::CPose3D& T_world_camera,
		const mrpt::math::TPoint3D& point) const;

	struct Step
	{
		mrpt::poses::CPose3D T_first_camera;
		Matrix6 covariance = Matrix6::Zero();  //!< of that
	};
	std::vector<Step> steps_;  //!< one a frame
};

}  // namespace semloop
