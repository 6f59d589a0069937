#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <regex>

#include "../mrpt_programs/MrptPrograms.h"

/** Debian's pf-localization, unmodified, in the map of the simulated flat: another walk of a robot whose
 *  camera stays at one height, known to the filter by its odometry and by instances alone. */
namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

const std::string kDemo = SEMLOOP_BINARY_DIR "/simulated_scene/";

/** A pose on the floor and where a sensor is on the robot that stands there, looking its way. */
struct RobotPose
{
	CPose2D robot;
	CPose3D sensor;
};

RobotPose robotPoseOf(const CPose3D& T_world_sensor)
{
	const auto& m = T_world_sensor.getRotationMatrix();
	const CPose2D robot(T_world_sensor.x(), T_world_sensor.y(), std::atan2(m(1, 0), m(0, 0)));
	return {robot, (-CPose3D(robot)) + T_world_sensor};
}

CObservation3DRangeScan::Ptr nextScan(RawlogReader& reader)
{
	while (const auto observation = reader.next())
		if (const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
			return scan;
	return nullptr;
}

class Localization : public testing::TestWithParam<int>
{
protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(kDemo + "demo.txt")) GTEST_SKIP() << "there is no simulation";
		const std::string whyNot = whyNotRunnable("pf-localization");
		if (!whyNot.empty()) GTEST_SKIP() << whyNot;
		const auto walk = shell(
			"'" SEMLOOP_BINARY_DIR "/bin/rawlog-simulate' '" SEMLOOP_SOURCE_DIR
			"/config_ini/scenes/apartment.ini' walk.rawlog --seed 1 --no-color --size 320x240"
			" --set camera.rate=2 --set path.minimum_height=1.3 --set path.maximum_height=1.3001"
			" --set path.sway_deg=20 --set path.sway_period=5 --set path.speed=0.5",
			folder_.path());
		ASSERT_EQ(walk.code, 0) << walk.err;
	}

	/** The walk from a frame on, in the world of the map: odometry with noise, and instances with
	 *  depth. */
	void writeRobotRawlog(std::size_t firstFrame, std::size_t frames)
	{
		// Where the map's world is in the flat.
		const CPose3D T_flat_world =
			absoluteTrajectoryError(associateByTime(
										readTumTrajectory(kDemo + "result/trajectory.tum"),
										readTumTrajectory(kDemo + "apartment_groundtruth.tum")))
				.T_truth_estimate;
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
			const auto pose = robotPoseOf((-T_flat_world) + camera + (-sensorFromCamera()));
			instances->sensorPose = pose.sensor;
			addDepth(rgbdFrameFrom(*scan).depth, *instances);
			out.write(movedTo(pose.robot));
			mrpt::obs::CSensoryFrame seen;
			seen.insert(instances);
			out.write(seen);
		}
		out.close();
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

	/** What wheels would report: 1 cm and 0.6 degrees of noise a step. */
	mrpt::obs::CActionCollection movedTo(const CPose2D& robot)
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
		mrpt::obs::CActionCollection actions;
		actions.insert(movement);
		return actions;
	}

	/** The shipped ini file with our files, and particles all over the map. */
	void writeIni() const
	{
		std::filesystem::copy_file(
			SEMLOOP_SOURCE_DIR "/config_ini/mrpt/pf-localization.ini", folder_.file("pf.ini"));
		mrpt::config::CConfigFile ini(folder_.file("pf.ini"));
		const std::string section = "LocalizationExperiment";
		ini.write(section, "map_file", kDemo + "result/map.simplemap");
		ini.write(section, "rawlog_file", folder_.file("robot.rawlog"));
		ini.write(section, "logOutput_dir", folder_.file("log"));
		mrpt::math::TPoint3D low(1e9, 1e9, 0), high(-1e9, -1e9, 0);
		const auto map = loadObjectMap(kDemo + "result/map.objmap");
		for (const auto& [id, object] : map->objects())
		{
			const auto centre = object.centre();
			low.x = std::min(low.x, centre.x), high.x = std::max(high.x, centre.x);
			low.y = std::min(low.y, centre.y), high.y = std::max(high.y, centre.y);
		}
		ini.write(section, "init_PDF_min_x", low.x);
		ini.write(section, "init_PDF_max_x", high.x);
		ini.write(section, "init_PDF_min_y", low.y);
		ini.write(section, "init_PDF_max_y", high.y);
		ini.writeNow();
	}

	/** Mean of the particles after each step. */
	std::vector<CPose2D> localize() const
	{
		const auto result = shell(
			"LD_PRELOAD='" SEMLOOP_BINARY_DIR
			"/lib/libsemloop-object_map.so' timeout 300 pf-localization pf.ini",
			folder_.path());
		EXPECT_EQ(result.code, 0) << result.err;
		std::vector<CPose2D> estimates;
		const std::regex line("PDF estimation: \\(([-0-9.]+),([-0-9.]+),([-0-9.]+)deg\\)");
		for (std::sregex_iterator match(result.out.begin(), result.out.end(), line), end;
			 match != end; ++match)
			estimates.emplace_back(
				std::stod((*match)[1]), std::stod((*match)[2]),
				std::stod((*match)[3]) * M_PI / 180);
		return estimates;
	}

	TemporaryFolder folder_;
	std::vector<CPose2D> truth_;
	std::mt19937 random_{1};
};

TEST_P(Localization, FromAnywhereInTheMapByInstancesAlone)
{
	writeRobotRawlog(std::size_t(GetParam()), 40);
	writeIni();
	const auto estimates = localize();
	ASSERT_EQ(estimates.size(), truth_.size());
	for (std::size_t i = 30; i < estimates.size(); ++i)
	{
		EXPECT_LT(estimates[i].distanceTo(truth_[i]), 0.3) << "step " << i;
		EXPECT_LT(
			std::abs(mrpt::math::wrapToPi(estimates[i].phi() - truth_[i].phi())), 10 * M_PI / 180)
			<< "step " << i;
	}
}

INSTANTIATE_TEST_SUITE_P(Start, Localization, testing::Values(0, 75));

}  // namespace
}  // namespace semloop
