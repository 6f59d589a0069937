#include "Simulator.h"

#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/simulation/CameraPath.h>

#include <chrono>

namespace semloop
{
namespace
{
constexpr double kGravity = 9.80665;  // [m/s^2]
constexpr float kDepthUnit = 0.001F;  // [m]

// What a random number is for, so that no two uses share theirs.
enum Stream : uint64_t
{
	kPathStream = 1,
	kOdometryStream,
	kDepthStream,
	kColorStream,
	kDetectorStream
};

/** A key of a stream's random numbers at a frame; the sensors mix its bits. */
uint64_t keyOf(uint64_t seed, Stream stream, std::size_t frame)
{
	return (seed * 8 + stream) << 32U | uint64_t(frame);
}

/** A fixed date, so that the same seed gives the same bytes: 2020-01-01. */
mrpt::Clock::time_point startTime()
{
	return mrpt::Clock::fromDouble(1577836800.0);
}

const std::vector<std::string>& sensorSections()
{
	static const std::vector<std::string> sections{
		"depth_sensor", "color_sensor", "detector", "odometry"};
	return sections;
}

/** What an accelerometer at rest measures. */
mrpt::obs::CObservationIMU accelerationAt(const StampedPose& camera)
{
	const auto T_world_sensor = camera.pose + (-sensorFromCamera());
	const auto up = T_world_sensor.inverseRotateVector({0, 0, kGravity});
	mrpt::obs::CObservationIMU imu;
	imu.timestamp = camera.time;
	imu.sensorLabel = "ACCEL";
	imu.set(mrpt::obs::IMU_X_ACC, up.x);
	imu.set(mrpt::obs::IMU_Y_ACC, up.y);
	imu.set(mrpt::obs::IMU_Z_ACC, up.z);
	return imu;
}
}  // namespace

Simulator::Simulator(
	const mrpt::config::CConfigFileBase& config, const FurnitureCatalog& catalog, uint64_t seed)
	: seed_(seed),
	  description_(SceneDescription::load(config, sensorSections())),
	  built_(buildScene(description_, catalog, seed)),
	  camera_(cameraOf(description_.camera))
{
	sensors_.depth.loadFromConfigFile(config, "depth_sensor");
	sensors_.color.loadFromConfigFile(config, "color_sensor");
	sensors_.detector.loadFromConfigFile(config, "detector");
	sensors_.odometry.loadFromConfigFile(config, "odometry");
	trajectory_ = carriedCamera(
		built_.way, description_.path, description_.camera.rate, startTime(),
		keyOf(seed, kPathStream, 0));
	renderer_ = std::make_unique<SceneRenderer>(built_.scene);
	try
	{
		// Whether the labels of its confusions exist the detector sees at a frame: better before any
		// file.
		frame(0, false);
	}
	catch (const UsageError& error)
	{
		throw UsageError(description_.file + ": [detector] " + error.what());
	}
}

Trajectory Simulator::odometry() const
{
	return corruptTrajectory(trajectory_, sensors_.odometry, keyOf(seed_, kOdometryStream, 0));
}

mrpt::obs::CObservation3DRangeScan::Ptr Simulator::scanOf(
	const RenderedView& view, std::size_t i) const
{
	const auto timestamp = trajectory_[i].time;
	const double time = mrpt::system::timeDifference(startTime(), timestamp);
	const cv::Mat depth = senseDepth(view, sensors_.depth, keyOf(seed_, kDepthStream, i));
	const cv::Mat color =
		view.color.empty() ? cv::Mat(depth.size(), CV_8UC3, cv::Scalar::all(0))
						   : senseColor(view, sensors_.color, time, keyOf(seed_, kColorStream, i));
	auto scan = rangeScanFrom(color, depth, kDepthUnit, camera_);
	scan->timestamp = timestamp;
	scan->maxRange = float(sensors_.depth.maximumRange);
	return scan;
}

SimulatedFrame Simulator::frame(std::size_t i, bool color) const
{
	const RenderedView view = renderer_->render(camera_, trajectory_[i].pose, color);
	const auto key = keyOf(seed_, kDetectorStream, i);
	SimulatedFrame result;
	result.acceleration = accelerationAt(trajectory_[i]);
	result.scan = scanOf(view, i);
	result.trueInstances = trueInstances(view, built_.scene, sensors_.detector, key);
	result.instances =
		detectInstances(view, renderer_->hiddenShares(view), built_.scene, sensors_.detector, key);
	for (auto* instances : {&result.trueInstances, &result.instances})
	{
		instances->timestamp = trajectory_[i].time;
		instances->sensorLabel = "INSTANCES";
		instances->sensorPose = result.scan->sensorPose;
	}
	return result;
}

}  // namespace semloop
