#include <mrpt/core/initializer.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/Lie/SE.h>
#include <semloop/config/Error.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/odometry/RecordedOdometry.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "PoseAlgebra.h"
#include "PoseNoise.h"

IMPLEMENTS_MRPT_OBJECT(RecordedOdometry, Odometry, semloop)

MRPT_INITIALIZER(registerRecordedOdometry)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::RecordedOdometry));
}

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;
using Time = mrpt::Clock::time_point;

constexpr std::size_t kReadingsKept = 100;

double secondsBetween(Time from, Time to)
{
	return std::chrono::duration<double>(to - from).count();
}

double square(double x)
{
	return x * x;
}

/** The pose a time after the last of two, at their speed. */
CPose3D extrapolated(const StampedPose& before, const StampedPose& last, double seconds)
{
	using SE3 = mrpt::poses::Lie::SE<3>;
	const double step = secondsBetween(before.time, last.time);
	if (!(step > 0)) return last.pose;
	auto motion = SE3::log(last.pose - before.pose);
	for (int i = 0; i < 6; i++) motion[i] *= seconds / step;
	return last.pose + SE3::exp(motion);
}
}  // namespace

void RecordedOdometryOptions::describe(OptionFields& f)
{
	f.text(
		"file", file,
		"the camera's trajectory in TUM format; empty: the rawlog's CObservationOdometry");
	f.number("max_gap", maxGap, 0, 1e6, "between the poses around a frame; more is lost [s]");
	f.number(
		"drift", drift, -1e3, 1e3,
		"experiment: the position's error grows evenly to this at the file's end [m]");
	f.degrees(
		"drift_yaw_deg", driftYaw, -180, 180, "experiment: same, about the first camera's y [deg]");
	f.number(
		"noise", noise, 0, 1e3,
		"experiment: standard deviation of each frame's position, an axis, independent [m]");
	f.degrees(
		"noise_deg", noiseAngle, 0, 180,
		"experiment: same, of the components of a rotation vector [deg]");
	f.integer("noise_seed", noiseSeed, 0, 2147483647, "experiment: of the noise's random numbers");
	f.number(
		"sigma_translation_per_metre", sigmaTranslationPerMetre, 0, 10,
		"standard deviation of a step's translation, a metre of its length");
	f.number(
		"sigma_rotation_per_radian", sigmaRotationPerRadian, 0, 10,
		"standard deviation of a step's rotation, a radian of its angle");
	f.number(
		"sigma_translation_floor", sigmaTranslationFloor, 1e-6, 10,
		"standard deviation of a step's translation, at least [m]");
	f.degrees(
		"sigma_rotation_floor_deg", sigmaRotationFloor, 1e-4, 180,
		"standard deviation of a step's rotation, at least [deg]");
	f.number(
		"sigma_translation_walk", translationWalk, 0, 10,
		"standard deviation after a metre of path, growing with its root [m]");
	f.degrees(
		"sigma_rotation_walk_deg", rotationWalk, 0, 180,
		"same, of the rotation after a metre of path [deg]");
	f.number(
		"lost_sigma_translation", lostSigmaTranslation, 1e-4, 100,
		"standard deviation added by each lost frame [m]");
	f.degrees("lost_sigma_rotation_deg", lostSigmaRotation, 1e-2, 180, "same, rotation [deg]");
}

RecordedOdometry::RecordedOdometry(const RecordedOdometryOptions& options)
	: options_(options), random_(uint64_t(options.noiseSeed))
{
	if (options_.file.empty())
	{
		if (options_.drift != 0 || options_.driftYaw != 0)
			throw UsageError(
				"drift without a file: not allowed; give the file, whose end the drift needs");
		return;
	}
	file_ = readTumTrajectory(options_.file);
	if (file_.empty())
		throw InputError(options_.file + ": holds no pose: give a trajectory in TUM format");
}

void RecordedOdometry::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	RecordedOdometryOptions options;
	options.loadFromConfigFile(config, section);
	try
	{
		*this = RecordedOdometry(options);
	}
	catch (const UsageError& e)
	{
		throw UsageError(configFileName(config) + ": [" + section + "] " + e.what());
	}
}

void RecordedOdometry::observe(const mrpt::obs::CObservation& observation)
{
	const auto* reading = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation);
	if (!reading) return;
	const StampedPose stamped{reading->timestamp, CPose3D(reading->odometry)};
	const auto place = std::upper_bound(
		robot_.begin(), robot_.end(), stamped,
		[](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
	robot_.insert(place, stamped);
	if (robot_.size() > kReadingsKept) robot_.erase(robot_.begin());
}

std::optional<CPose3D> RecordedOdometry::robotPose(Time time) const
{
	if (robot_.empty()) return std::nullopt;
	const auto& last = robot_.back();
	const double ahead = secondsBetween(last.time, time);
	if (ahead <= 0) return interpolate(robot_, time, options_.maxGap);
	if (ahead > options_.maxGap) return std::nullopt;
	if (robot_.size() == 1) return last.pose;
	return extrapolated(robot_[robot_.size() - 2], last, ahead);
}

std::optional<CPose3D> RecordedOdometry::recordedPose(
	const RgbdFrame& frame, std::string& why) const
{
	if (file_.empty())
	{
		const auto pose = robotPose(frame.time);
		if (pose) return *pose + frame.T_robot_camera;
		why = "no CObservationOdometry within " + std::to_string(options_.maxGap) + " s of " +
			  formatUnixTime(frame.time);
		return std::nullopt;
	}
	const auto pose = interpolate(file_, frame.time, options_.maxGap);
	if (!pose)
		why = options_.file + ": no poses around " + formatUnixTime(frame.time) + " within " +
			  std::to_string(options_.maxGap) + " s";
	return pose;
}

double RecordedOdometry::progress(Time time) const
{
	if (file_.empty() || !firstTime_) return 0;
	const double duration = secondsBetween(*firstTime_, file_.back().time);
	if (!(duration > 0)) return 0;
	return std::clamp(secondsBetween(*firstTime_, time) / duration, 0.0, 1.0);
}

CPose3D RecordedOdometry::drifted(const CPose3D& T_odom_camera, Time time) const
{
	const double s = progress(time);
	Eigen::Isometry3d T = toIsometry(T_odom_camera);
	T.linear() =
		Eigen::AngleAxisd(s * options_.driftYaw, Eigen::Vector3d::UnitY()).matrix() * T.linear();
	T.translation().x() += s * options_.drift;
	return toPose(T);
}

RecordedOdometry::Matrix6 RecordedOdometry::stepCovariance(
	const CPose3D& T_previous_camera, Time time) const
{
	const double share =
		previousTime_ ? std::max(0.0, progress(time) - progress(*previousTime_)) : 0.0;
	const double translation =
		square(T_previous_camera.norm() * options_.sigmaTranslationPerMetre) +
		square(options_.sigmaTranslationFloor) + square(options_.drift) * share +
		square(options_.translationWalk) * T_previous_camera.norm() + 2 * square(options_.noise);
	const double rotation =
		square(rotationAngle(T_previous_camera) * options_.sigmaRotationPerRadian) +
		square(options_.sigmaRotationFloor) + square(options_.driftYaw) * share +
		square(options_.rotationWalk) * T_previous_camera.norm() + 2 * square(options_.noiseAngle);
	return diagonalCovariance(std::sqrt(translation), std::sqrt(rotation));
}

OdometryEstimate RecordedOdometry::track(const RgbdFrame& frame)
{
	if (!firstTime_) firstTime_ = frame.time;
	OdometryEstimate estimate;
	const auto T_record_camera = recordedPose(frame, estimate.reason);
	const CPose3D predicted = motion_.predict(frame.time);
	const bool anchored = T_odom_record_.has_value();
	if (T_record_camera)
	{
		// Frames without a pose may have come first; the model then stood still at the origin.
		if (!anchored) T_odom_record_ = orthonormalized(T_odom_previous_ + (-*T_record_camera));
		estimate.T_odom_camera = drifted(*T_odom_record_ + *T_record_camera, frame.time);
		if (anchored && (options_.noise > 0 || options_.noiseAngle > 0))
			estimate.T_odom_camera =
				withNoise(estimate.T_odom_camera, options_.noise, options_.noiseAngle, random_);
		estimate.T_previous_camera = orthonormalized(estimate.T_odom_camera - T_odom_previous_);
	}
	else
	{
		estimate.status = OdometryEstimate::Status::Lost;
		estimate.T_previous_camera = predicted;
		estimate.T_odom_camera = orthonormalized(T_odom_previous_ + predicted);
	}
	const Matrix6 guessed = covarianceSeenFrom(estimate.T_previous_camera, lostCovariance_);
	estimate.covariance = stepCovariance(estimate.T_previous_camera, frame.time) + guessed;
	const bool wasLost = !lostCovariance_.isZero(0);
	if (T_record_camera)
	{
		if (wasLost || !anchored)
			motion_.stop(frame.time);
		else
			motion_.measured(frame.time, estimate.T_previous_camera);
		lostCovariance_.setZero();
	}
	else
	{
		estimate.covariance +=
			diagonalCovariance(options_.lostSigmaTranslation, options_.lostSigmaRotation);
		lostCovariance_ = estimate.covariance;
		motion_.passed(frame.time);
	}
	T_odom_previous_ = estimate.T_odom_camera;
	previousTime_ = frame.time;
	return estimate;
}

}  // namespace semloop
