#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/observations/RgbdFrame.h>

#include <Eigen/Core>
#include <string>

namespace semloop
{
/** How the camera moved since the previous frame. */
struct OdometryEstimate
{
	enum class Status
	{
		Tracked,  //!< measured
		Lost      //!< not measured: the motion model's guess; reason says why
	};

	Status status = Status::Tracked;
	std::string reason;                      //!< one line for a person when lost
	mrpt::poses::CPose3D T_odom_camera;      //!< identity at the first frame
	mrpt::poses::CPose3D T_previous_camera;  //!< identity at the first frame
	/** Covariance of log(T_previous_camera^-1 * truth), order of mrpt::poses::Lie::SE<3>: translation
	 *  [m^2] first, then rotation [rad^2]. Positive definite. */
	Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
};

/** Frames -> relative poses. Camera poses are of the optical frame. A module. */
class Odometry : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(Odometry)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;

	/** Any other observation that came before the next frame (wheel odometry, IMU). */
	virtual void observe(const mrpt::obs::CObservation& observation) { (void)observation; }

	/** Frames come in order of time, rectified. */
	virtual OdometryEstimate track(const RgbdFrame& frame) = 0;
};

}  // namespace semloop
