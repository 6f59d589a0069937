#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/association/FrameRegistration.h>
#include <semloop/odometry/Odometry.h>

namespace semloop
{
/** Where the camera is, seen from where the odometry has it: T_odometry_camera, from what the tracked
 *  and the mapped objects say about it (registerFrame). Two things are known of a new frame:
 *
 *   - it is where the last one was, moved by the step that the tracked objects confirmed, with the
 *     variance of that one plus that of the step;
 *   - it is where the odometry has it, off by the noise of one pose, half of a step's variance as a step
 *     is the difference of two poses, and by the odometry's bias: what it lost for good. The bias is none
 *     and certain until the odometry is lost; then its variance grows by those of the lost steps and of
 *     the one behind them, and it is learned from the corrections.
 *
 *  The mean weighted by the inverse variances is the prior for the map's registration. So where the
 *  odometry is good the camera stays with it, drift included, which is for the loop closure to mend;
 *  where it is noisy, or was lost, the objects hold the camera. */
class CameraCorrection
{
public:
	/** A step of the odometry; correction and bias, in the camera's frame, move along. */
	void step(const OdometryEstimate& odometry);
	/** All steps since the last track(), and their uncertainty. */
	const mrpt::poses::CPose3D& T_previous_camera() const { return T_previous_camera_; }
	const PoseSigma& stepSigma() const { return stepSigma_; }

	/** What the tracked objects say about T_previous_camera(). */
	void track(const FrameRegistration& tracked);
	/** What the mapped objects say about the pose with this correction. */
	void localize(const FrameRegistration& mapped);

	const mrpt::poses::CPose3D& T_odometry_camera() const { return T_odometry_camera_; }
	const PoseSigma& sigma() const { return sigma_; }

private:
	mrpt::poses::CPose3D T_previous_camera_;
	PoseSigma stepSigma_;
	PoseSigma poseSigma_;  //!< noise of one pose of the odometry
	mrpt::poses::CPose3D T_odometry_camera_;
	PoseSigma sigma_;
	mrpt::poses::CPose3D T_odometry_biased_;
	PoseSigma biasSigma_;
	bool wasLost_ = false;
};

}  // namespace semloop
