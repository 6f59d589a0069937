#pragma once

#include <mrpt/core/bits_math.h>
#include <semloop/config/Options.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/odometry/ConstantVelocity.h>
#include <semloop/odometry/Odometry.h>

#include <optional>
#include <random>
#include <string>

namespace semloop
{
struct RecordedOdometryOptions : Options
{
	std::string file;
	double maxGap = 0.2;    //!< [s]
	double drift = 0;       //!< [m]
	double driftYaw = 0;    //!< [rad]
	double noise = 0;       //!< [m]
	double noiseAngle = 0;  //!< [rad]
	int noiseSeed = 1;
	double sigmaTranslationPerMetre = 0.02;
	double sigmaRotationPerRadian = 0.02;
	double sigmaTranslationFloor = 0.001;             //!< [m]
	double sigmaRotationFloor = mrpt::DEG2RAD(0.05);  //!< [rad]
	double translationWalk = 0;                       //!< [m / sqrt(m)]
	double rotationWalk = 0;                          //!< [rad / sqrt(m)]
	double lostSigmaTranslation = 0.05;               //!< [m]
	double lostSigmaRotation = mrpt::DEG2RAD(5.0);    //!< [rad]

protected:
	void describe(OptionFields& f) override;
};

/** Odometry that somebody else computed: a trajectory of the camera's optical frame in TUM format
 *  or, without a file, the planar odometry of the robot (mrpt::obs::CObservationOdometry) that
 *  comes through observe(), carried to the camera by the frame's T_robot_camera.
 *
 *  Poses are interpolated to the frame's time; a file's neighbours may be maxGap apart. Robot odometry
 *  comes before its frame: behind its last reading the last speed goes on for at most maxGap. Where
 *  there is no pose, the constant-velocity model goes on, Lost; the next pose found mends it.
 *
 *  Experiment: with drift d and drift_yaw a, and s = time since the first frame / time from there to
 *  the file's end, in [0, 1], the pose (R, t) in the odometry's world becomes
 *
 *      ( R_y(s a) R,  t + s d e_x )        e_x right, e_y down in the first camera's frame,
 *
 *  so that the position error grows evenly to d and the relative poses are those of the corrupted
 *  trajectory. The covariance grows with it: d^2, a^2 in sum over the file, as if it were a random walk.
 *
 *  Experiment of Sec. IV-A: with noise s_t and noise_deg s_r the pose of every frame but the first,
 *  (R, t) in the odometry's world, becomes (R exp(w), t + n), where every component of n and w is drawn
 *  anew from N(0, s_t^2) and N(0, s_r^2): a localisation noise that does not add up. A step has that of
 *  two poses: 2 s_t^2 and 2 s_r^2 more covariance.
 *
 *  Covariance of a step of length l and angle r: (l sigma_per_metre)^2 + floor^2 + l walk^2 of the
 *  translation, (r sigma_per_radian)^2 + floor^2 + l walk^2 of the rotation. The walk is what a drift
 *  amounts to whatever the frame rate: its sum over a path of length L is L walk^2. */
class RecordedOdometry : public Odometry
{
	DEFINE_MRPT_OBJECT(RecordedOdometry, semloop)

public:
	RecordedOdometry() = default;
	/** Throws InputError when the file cannot be read or holds no pose, UsageError for a drift
	 *  without a file. */
	explicit RecordedOdometry(const RecordedOdometryOptions& options);

	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	/** Takes CObservationOdometry, passes over all others. */
	void observe(const mrpt::obs::CObservation& observation) override;

	OdometryEstimate track(const RgbdFrame& frame) override;

private:
	using Matrix6 = Eigen::Matrix<double, 6, 6>;

	/** T_record_camera; empty, and why, when there is none. */
	std::optional<mrpt::poses::CPose3D> recordedPose(
		const RgbdFrame& frame, std::string& why) const;
	std::optional<mrpt::poses::CPose3D> robotPose(mrpt::Clock::time_point time) const;
	/** s of the drift. */
	double progress(mrpt::Clock::time_point time) const;
	mrpt::poses::CPose3D drifted(
		const mrpt::poses::CPose3D& T_odom_camera, mrpt::Clock::time_point time) const;
	Matrix6 stepCovariance(
		const mrpt::poses::CPose3D& T_previous_camera, mrpt::Clock::time_point time) const;

	RecordedOdometryOptions options_;
	Trajectory file_;   //!< empty: from observe()
	Trajectory robot_;  //!< the last readings
	std::optional<mrpt::Clock::time_point> firstTime_, previousTime_;
	std::optional<mrpt::poses::CPose3D> T_odom_record_;  //!< known since the first pose found
	mrpt::poses::CPose3D T_odom_previous_;
	Matrix6 lostCovariance_ = Matrix6::Zero();  //!< of the previous pose, when that was guessed
	ConstantVelocity motion_;
	std::mt19937_64 random_;
};

}  // namespace semloop
