#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/observations/Trajectory.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "TemporaryFolder.h"

/** The programs on freiburg1_desk of the TUM RGB-D benchmark, with networks; see prepare.sh. */
namespace semloop
{
namespace
{
using mrpt::math::TBoundingBox;
using mrpt::math::TPoint3D;
using testing::AllOf;
using testing::Ge;
using testing::Le;

class Desk : public testing::Test
{
protected:
	void SetUp() override
	{
		const char* const data = std::getenv("SEMLOOP_DATA");
		if (!data || !std::filesystem::exists(std::string(data) + "/data/tum_fr1_desk"))
			GTEST_SKIP() << "SEMLOOP_DATA has no data/tum_fr1_desk";
	}

	/** Runs semloop-slam into the folder `result`. */
	void map(const std::string& config, const std::string& result, const std::string& options = {})
	{
		const std::string command =
			SEMLOOP_BINARY_DIR "/bin/semloop-slam -c " SEMLOOP_SOURCE_DIR "/config_ini/" + config +
			" -i " + kRecording + ".rawlog -o '" + folder_.file(result) + "' " + options + " > '" +
			folder_.file("log") + "' 2>&1";
		const int status = std::system(command.c_str());
		ASSERT_TRUE(WIFEXITED(status));
		ASSERT_EQ(WEXITSTATUS(status), 0) << readBytes(folder_.file("log"));
	}
	/** The truth as odometry, spoilt by a drift [m]. */
	void mapWithDrift(
		const std::string& drift, const std::string& result, const std::string& options = {})
	{
		map("recorded_odometry.ini", result,
			std::string("--set odometry.file=") + kTruth + " --set odometry.drift=" + drift + " " +
				options);
	}
	/** RMSE after alignment [m]. */
	double error(const std::string& trajectory) const
	{
		return absoluteTrajectoryError(
				   associateByTime(
					   readTumTrajectory(folder_.file(trajectory)), readTumTrajectory(kTruth)))
			.translation.rmse;
	}
	nlohmann::json json(const std::string& name) const
	{
		return nlohmann::json::parse(readBytes(folder_.file(name)));
	}

	static constexpr const char* kRecording = SEMLOOP_BINARY_DIR "/real_sequence/desk";
	static constexpr const char* kTruth = SEMLOOP_BINARY_DIR "/real_sequence/desk_groundtruth.tum";
	TemporaryFolder folder_;
};

/** Around the object, axis-aligned in the world. */
TBoundingBox worldBox(const Object& object)
{
	const auto box = object.volume->boundingBox().value();
	auto result = TBoundingBox::PlusMinusInfinity();
	for (const double x : {box.min.x, box.max.x})
		for (const double y : {box.min.y, box.max.y})
			for (const double z : {box.min.z, box.max.z})
				result.updateWithPoint(object.T_world_object.composePoint(TPoint3D(x, y, z)));
	return result;
}

double intersectionOverUnion(const TBoundingBox& a, const TBoundingBox& b)
{
	const auto both = a.intersection(b);
	return both ? both->volume() / (a.volume() + b.volume() - both->volume()) : 0;
}

TEST_F(Desk, EveryObjectIsInTheMapOnce)
{
	ASSERT_NO_FATAL_FAILURE(map("tum_rgbd.ini", "out"));
	for (const char* name :
		 {"trajectory.tum", "trajectory_odometry.tum", "objects.json", "map.objmap",
		  "map.simplemap", "scene.3Dscene", "pose_graph.g2o", "loops.jsonl", "timings.csv"})
		EXPECT_FALSE(readBytes(folder_.file(std::string("out/") + name)).empty()) << name;

	const auto summary = json("out/summary.json");
	EXPECT_EQ(summary["frames"], 573);
	EXPECT_EQ(summary["frames_lost"], 0);
	EXPECT_GE(summary["loops_accepted"], 1);
	// What a person counts on the desk, give or take what is seen at a glance or at the border only.
	const auto& counts = summary["objects_by_label"];
	const auto count = [&](const char* label) { return counts.value(label, 0); };
	EXPECT_THAT(count("book"), AllOf(Ge(3), Le(8)));
	EXPECT_THAT(count("keyboard"), AllOf(Ge(1), Le(4)));
	EXPECT_THAT(count("tv") + count("laptop"), AllOf(Ge(3), Le(7)));
	EXPECT_THAT(count("chair"), AllOf(Ge(1), Le(2)));
	EXPECT_THAT(count("mouse"), AllOf(Ge(1), Le(3)));

	const auto objects = loadObjectMap(folder_.file("out/map.objmap"));
	for (const auto& [id, a] : objects->objects())
		for (const auto& [other, b] : objects->objects())
		{
			if (id >= other) continue;
			EXPECT_LE(
				intersectionOverUnion(worldBox(a), worldBox(b)), a.label() == b.label() ? 0.3 : 0.6)
				<< objects->labelName(a) << " " << id << " and " << objects->labelName(b) << " "
				<< other;
		}

	// OpenCV's odometry from frame to frame is off by 0.31 m here.
	EXPECT_LT(error("out/trajectory.tum"), 0.06);
}

TEST_F(Desk, LoopClosuresMoreThanHalveADriftOfHalfAMetre)
{
	for (const char* const drift : {"0.5", "-0.5"})
	{
		ASSERT_NO_FATAL_FAILURE(mapWithDrift(drift, "out"));
		EXPECT_GE(json("out/summary.json")["loops_accepted"], 1);
		const double before = error("out/trajectory_odometry.tum");
		// A drift that grows evenly from 0 to d has a standard deviation of d / sqrt(12).
		EXPECT_NEAR(before, 0.5 / std::sqrt(12.0), 0.005);
		EXPECT_LT(error("out/trajectory.tum"), 0.5 * before) << "drift " << drift << " m";
	}
}

TEST_F(Desk, TwoRunsGiveTheSameBytes)
{
	ASSERT_NO_FATAL_FAILURE(mapWithDrift("0.5", "with"));
	ASSERT_NO_FATAL_FAILURE(mapWithDrift("0.5", "without", "--set slam.frames_ahead=0"));
	EXPECT_GE(json("with/summary.json")["loops_accepted"], 1);
	for (const char* name : {"trajectory.tum", "objects.json", "loops.jsonl", "pose_graph.g2o"})
	{
		const std::string with = readBytes(folder_.file(std::string("with/") + name));
		EXPECT_GT(with.size(), 100U) << name;
		EXPECT_EQ(with, readBytes(folder_.file(std::string("without/") + name))) << name;
	}
}
}  // namespace
}  // namespace semloop
