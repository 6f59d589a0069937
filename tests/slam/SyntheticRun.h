#pragma once

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/Trajectory.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "SyntheticScene.h"
#include "TemporaryFolder.h"

/** A camera that turns on a circle in a room with objects along the walls and comes back to where it
 *  began: rawlog with images and masks, and the true trajectory. */
namespace semloop::synthetic
{
struct RunOptions
{
	double degrees = 450;  //!< how far round
	double step = 5;       //!< degrees between two frames
	int objects = 16;
	bool withInstances = true;
};

/** Where the camera is on its circle of 1.2 m; it looks outwards and a little down. */
inline CPose3D cameraOnCircle(double degrees)
{
	const double a = degrees * M_PI / 180;
	return lookAt(
		{1.2 * std::cos(a), 1.2 * std::sin(a), 1.2}, {3 * std::cos(a), 3 * std::sin(a), 0.9});
}

/** Boxes and spheres of eight labels at 3 m from the centre, unevenly spread, no two of one label
 *  beside each other. */
inline Scene roomScene(int objects)
{
	Scene scene;
	scene.planes.push_back({{0, 0, 1}, 0, {90, 90, 90}, 0, 0});
	for (int i = 0; i < objects; ++i)
	{
		const double a = 2 * M_PI * (i + 0.25 * std::sin(5.0 * i)) / objects;
		const double r = 2.8 + 0.3 * std::cos(3.0 * i), z = 0.7 + 0.25 * std::sin(7.0 * i);
		const TPoint3D at(r * std::cos(a), r * std::sin(a), z);
		const cv::Vec3b color(uint8_t(50 + 37 * i % 200), uint8_t(60 + 91 * i % 190), uint8_t(120));
		const double size = 0.25 + 0.08 * std::cos(2.0 * i);
		if (i % 2)
			scene.spheres.push_back({at, size / 2, color, i + 1, 0});
		else
			scene.boxes.push_back(
				{CPose3D(at.x, at.y, at.z, 0.7 * i, 0, 0), {size, size, size}, color, i + 1, 0});
	}
	return scene;
}

inline uint32_t labelOf(int object)
{
	return uint32_t((object * 3) % 8);
}

inline LabelSet roomLabels()
{
	return LabelSet({"bin", "bottle", "box", "chair", "cup", "lamp", "plant", "screen"});
}

inline mrpt::Clock::time_point frameTime(int index)
{
	return mrpt::Clock::fromDouble(1000 + 0.1 * index);
}

inline mrpt::obs::CObservation3DRangeScan scanOf(const View& view, int index)
{
	mrpt::obs::CObservation3DRangeScan scan;
	scan.timestamp = frameTime(index);
	scan.sensorLabel = "RGBD";
	scan.hasRangeImage = scan.hasIntensityImage = true;
	scan.range_is_depth = true;
	scan.rangeUnits = 0.001f;
	const cv::Mat& depth = view.frame.depth;
	scan.rangeImage_setSize(depth.rows, depth.cols);
	for (int v = 0; v < depth.rows; ++v)
		for (int u = 0; u < depth.cols; ++u)
		{
			// What 16 bits of millimetres cannot say, a sensor does not see.
			const long millimetres = std::lround(depth.at<float>(v, u) * 1000);
			scan.rangeImage(v, u) = millimetres <= 65535 ? uint16_t(millimetres) : uint16_t(0);
		}
	scan.intensityImage = mrpt::img::CImage(view.frame.color, mrpt::img::DEEP_COPY);
	scan.cameraParams = scan.cameraParamsIntensity = view.frame.camera;
	scan.relativePoseIntensityWRTDepth = CPose3D::FromYawPitchRoll(-M_PI / 2, 0, -M_PI / 2);
	return scan;
}

inline CObservationInstances instancesOf(const View& view, int index)
{
	CObservationInstances instances;
	instances.timestamp = frameTime(index);
	instances.sensorLabel = "RGBD_instances";
	instances.camera = view.frame.camera;
	instances.labels = roomLabels();
	for (int id = 1; id < int(view.masks.size()); ++id)
		if (view.masks[std::size_t(id)].area() > 40)
		{
			instances.instances.push_back(
				makeInstance(view.masks[std::size_t(id)], labelOf(id), 0.9f));
			instances.instances.back().trueObject = uint32_t(id);
		}
	return instances;
}

struct RecordedRun
{
	std::string rawlog;
	std::string truth;  //!< TUM trajectory
	int frames = 0;
};

inline RecordedRun recordRun(const TemporaryFolder& folder, const RunOptions& options = {})
{
	RecordedRun run;
	run.rawlog = folder.file("room.rawlog");
	run.truth = folder.file("room_groundtruth.tum");
	const Scene scene = roomScene(options.objects);
	RawlogWriter writer(run.rawlog);
	Trajectory truth;
	for (double angle = 0; angle <= options.degrees; angle += options.step, ++run.frames)
	{
		const CPose3D pose = cameraOnCircle(angle);
		const View view = renderView(scene, smallCamera(), pose);
		writer.write(scanOf(view, run.frames));
		if (options.withInstances) writer.write(instancesOf(view, run.frames));
		truth.push_back({frameTime(run.frames), pose});
	}
	writer.close();
	writeTumTrajectory(run.truth, truth);
	return run;
}

/** A configuration for such a run: recorded odometry with this drift at the end [m]. */
inline mrpt::config::CConfigFileMemory runConfiguration(const RecordedRun& run, double drift)
{
	mrpt::config::CConfigFileMemory config;
	config.write("modules", "odometry", "semloop::RecordedOdometry");
	config.write("odometry", "file", run.truth);
	config.write("odometry", "drift", drift);
	config.write("tracking", "min_tracked_frames", 2);
	config.write("slam", "min_observations", 3);
	config.write("loop_detection", "min_observations", 3);
	config.write("slam", "loop_every_frames", 2);
	config.write("segmentation", "file", run.rawlog);
	return config;
}

}  // namespace semloop::synthetic
