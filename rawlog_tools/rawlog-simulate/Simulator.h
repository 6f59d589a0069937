#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/simulation/ColorSensor.h>
#include <semloop/simulation/DepthSensor.h>
#include <semloop/simulation/OdometryNoise.h>
#include <semloop/simulation/SceneBuilder.h>
#include <semloop/simulation/SceneRenderer.h>
#include <semloop/simulation/SimulatedDetector.h>

#include <cstdint>
#include <memory>

namespace semloop
{
/** What the sensors give at one moment. */
struct SimulatedFrame
{
	mrpt::obs::CObservationIMU acceleration;
	mrpt::obs::CObservation3DRangeScan::Ptr scan;
	CObservationInstances trueInstances, instances;
};

/** A scene, a camera that is carried through it, and its sensors. */
class Simulator
{
public:
	/** Beyond, two seeds would share random numbers. */
	static constexpr int64_t kMostSeed = (1 << 29) - 1;

	/** Throws UsageError or InputError, naming the scene's file. */
	Simulator(
		const mrpt::config::CConfigFileBase& config, const FurnitureCatalog& catalog,
		uint64_t seed);

	const Scene& scene() const { return built_.scene; }
	const Trajectory& trajectory() const { return trajectory_; }  //!< T_world_camera
	Trajectory odometry() const;
	const mrpt::img::TCamera& camera() const { return camera_; }

	/** Frame i of the trajectory; its numbers depend on the seed and i only. Can be called from
	 *  several threads. */
	SimulatedFrame frame(std::size_t i, bool color) const;

private:
	struct Sensors
	{
		DepthSensorOptions depth;
		ColorSensorOptions color;
		SimulatedDetectorOptions detector;
		OdometryNoiseOptions odometry;
	};
	mrpt::obs::CObservation3DRangeScan::Ptr scanOf(const RenderedView& view, std::size_t i) const;

	uint64_t seed_;
	SceneDescription description_;
	Sensors sensors_;
	BuiltScene built_;
	mrpt::img::TCamera camera_;
	Trajectory trajectory_;
	std::unique_ptr<SceneRenderer> renderer_;
};

}  // namespace semloop
