#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/T3DPointsTo2DScanParams.h>
#include <mrpt/poses/CPose2D.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "Shell.h"

namespace semloop
{
inline const std::string kDemo = SEMLOOP_BINARY_DIR "/simulated_scene/";

/** Another walk through the flat of the demo, by a robot on wheels whose camera stays at one height: a
 *  rawlog as MRPT's SLAM programs read it, pairs of actions and sensory frames, at 2 Hz. */
class RobotWalk
{
public:
	using CPose2D = mrpt::poses::CPose2D;
	using CPose3D = mrpt::poses::CPose3D;

	/** Simulates it in a folder. */
	explicit RobotWalk(const TemporaryFolder& folder) : folder_(folder)
	{
		const auto walk = shell(
			"'" SEMLOOP_BINARY_DIR "/bin/rawlog-simulate' '" SEMLOOP_SOURCE_DIR
			"/config_ini/scenes/apartment.ini' walk.rawlog --seed 1 --no-color --size 320x240"
			" --set camera.rate=2 --set path.minimum_height=1.3 --set path.maximum_height=1.3001"
			" --set path.sway_deg=20 --set path.sway_period=5 --set path.speed=0.5",
			folder_.path());
		EXPECT_EQ(walk.code, 0) << walk.err;
	}

	/** From now on in the world of the demo's map; otherwise in the flat's own. */
	void useWorldOfTheMap()
	{
		T_flat_world_ =
			absoluteTrajectoryError(associateByTime(
										readTumTrajectory(kDemo + "result/trajectory.tum"),
										readTumTrajectory(kDemo + "apartment_groundtruth.tum")))
				.T_truth_estimate;
	}

	/** robot.rawlog: the walk from a frame on, odometry with noise, instances with depth and, if asked
	 *  for, a horizontal scan. */
	void write(std::size_t firstFrame, std::size_t frames, bool withScan)
	{
		const Trajectory cameras = readTumTrajectory(folder_.file("walk_groundtruth.tum"));
		RawlogReader scans(folder_.file("walk.rawlog"));
		RawlogReader sidecar(folder_.file("walk_instances.rawlog"));
		RawlogWriter out(folder_.file("robot.rawlog"));
		std::size_t frame = 0;
		while (const auto observation = sidecar.next())
		{
			const auto instances = std::dynamic_pointer_cast<CObservationInstances>(observation);
			if (!instances) continue;  // the header
			const auto scan = nextScan(scans);
			ASSERT_TRUE(scan && scan->timestamp == instances->timestamp);
			const auto& camera = cameras.at(frame).pose;
			if (frame++ < firstFrame) continue;
			if (truth_.size() == frames) break;
			const CPose3D T_world_sensor = (-T_flat_world_) + camera + (-sensorFromCamera());
			const CPose2D robot = robotBelow(T_world_sensor);
			scan->sensorPose = instances->sensorPose = (-CPose3D(robot)) + T_world_sensor;
			addDepth(rgbdFrameFrom(*scan).depth, *instances);
			out.write(movedTo(robot, scan->timestamp));
			mrpt::obs::CSensoryFrame seen;
			seen.insert(instances);
			if (withScan) seen.insert(horizontalScan(*scan));
			out.write(seen);
		}
		out.close();
	}

	/** Where the robot was at each of the frames, in that world. */
	const std::vector<CPose2D>& truth() const { return truth_; }
	const CPose3D& T_flat_world() const { return T_flat_world_; }

private:
	using CObservation3DRangeScan = mrpt::obs::CObservation3DRangeScan;

	static CObservation3DRangeScan::Ptr nextScan(RawlogReader& reader)
	{
		while (const auto observation = reader.next())
			if (const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
				return scan;
		return nullptr;
	}

	/** It looks the way the sensor does. */
	static CPose2D robotBelow(const CPose3D& T_world_sensor)
	{
		const auto& m = T_world_sensor.getRotationMatrix();
		return CPose2D(T_world_sensor.x(), T_world_sensor.y(), std::atan2(m(1, 0), m(0, 0)));
	}

	static void addDepth(const cv::Mat& depth, CObservationInstances& instances)
	{
		for (auto& instance : instances.instances)
		{
			instance.depth.emplace();
			instance.depth->unit = 0.001f;
			depth(instance.box).convertTo(instance.depth->depth, CV_16U, 1000);
		}
	}

	/** At the camera's height, as a laser would. */
	static mrpt::obs::CObservation2DRangeScan::Ptr horizontalScan(CObservation3DRangeScan& scan)
	{
		mrpt::obs::T3DPointsTo2DScanParams params;
		params.use_origin_sensor_pose = true;
		params.z_min = scan.sensorPose.z() - 0.1;
		params.z_max = scan.sensorPose.z() + 0.1;
		scan.load();
		const auto result = mrpt::obs::CObservation2DRangeScan::Create();
		scan.convertTo2DScan(*result, params);
		result->timestamp = scan.timestamp;
		result->sensorLabel = "LASER";
		return result;
	}

	/** What wheels would report: 1 cm and 0.6 degrees of noise a step. */
	mrpt::obs::CActionCollection movedTo(const CPose2D& robot, mrpt::Clock::time_point time)
	{
		CPose2D step = truth_.empty() ? CPose2D() : robot - truth_.back();
		truth_.push_back(robot);
		std::normal_distribution<double> noise(0, 0.01);
		step = CPose2D(
			step.x() + noise(random_), step.y() + noise(random_), step.phi() + noise(random_));
		mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
		model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
		model.gaussianModel.minStdXY = 0.02f;
		model.gaussianModel.minStdPHI = 0.02f;
		mrpt::obs::CActionRobotMovement2D movement;
		movement.computeFromOdometry(step, model);
		movement.timestamp = time;
		mrpt::obs::CActionCollection actions;
		actions.insert(movement);
		return actions;
	}

	const TemporaryFolder& folder_;
	CPose3D T_flat_world_;
	std::vector<CPose2D> truth_;
	std::mt19937 random_{1};
};

}  // namespace semloop
