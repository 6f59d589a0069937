#include <semloop/object_map/SemanticGraph.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/Trajectory.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "SceneNn2RawlogFixture.h"

namespace semloop::test
{
namespace
{
namespace fs = std::filesystem;
using ::testing::HasSubstr;

template <typename Observation>
std::vector<std::shared_ptr<Observation>> readAll(const std::string& rawlog)
{
	std::vector<std::shared_ptr<Observation>> result;
	RawlogReader reader(rawlog);
	while (const auto observation = reader.next())
		if (auto wanted = std::dynamic_pointer_cast<Observation>(observation))
			result.push_back(wanted);
	return result;
}

std::map<uint32_t, const Instance*> byTrueObject(const CObservationInstances& observation)
{
	std::map<uint32_t, const Instance*> result;
	for (const auto& instance : observation.instances)
		result[instance.trueObject.value()] = &instance;
	return result;
}

TEST_F(SceneNn2Rawlog, MasksAreWhereTheObjectsAreSeen)
{
	const auto result = runAnnotated();
	ASSERT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.out, HasSubstr("4 objects (4 seen; 1 more are not in the mesh)"));
	const auto frames = readAll<CObservationInstances>(written("room_truth_instances.rawlog"));
	ASSERT_EQ(frames.size(), std::size_t(kFrames));
	for (int i = 0; i < kFrames; i++)
	{
		const View view = viewOf(i);
		frames[i]->validate();
		EXPECT_EQ(
			frames[i]->labels.names(),
			(std::vector<std::string>{"chair", "coffee table", "floor", "wall"}));
		const auto instances = byTrueObject(*frames[i]);
		for (const auto& [label, id, name] :
			 {std::tuple{kChairLabel, kChair, "chair"},
			  std::tuple{kTableLabel, kTable, "coffee table"}})
		{
			ASSERT_EQ(instances.count(label), 1U) << name << " in frame " << i;
			const Instance& instance = *instances.at(label);
			EXPECT_GT(intersectionOverUnion(instance.mask, view.masks[id]), 0.98)
				<< name << " in frame " << i;
			EXPECT_EQ(frames[i]->labels.name(instance.label()), name);
			EXPECT_EQ(instance.labelScores.front().score, 1.0F);
			EXPECT_EQ(instance.box, instance.mask.boundingBox());
		}
		EXPECT_EQ(instances.size(), 4U);
		for (const auto& instance : frames[i]->instances)
			for (const int id : {kUnnamed, kNotInMesh})
			{
				// Nearest to another's vertex are only the last pixels of an edge.
				const auto foreign = intersectionArea(instance.mask, view.masks[id]);
				EXPECT_LE(double(foreign), 0.01 * double(view.masks[id].area()))
					<< "frame " << i << ", object " << *instance.trueObject;
			}
	}
}

TEST_F(SceneNn2Rawlog, ThePosesAreTheTrajectorysInAWorldWithZUp)
{
	ASSERT_EQ(run("--start-time 1600000000.5 --trajectory " + given("trajectory.log")).code, 0);
	const auto poses = readTumTrajectory(written("room_groundtruth.tum"));
	const auto scans = readAll<CObservation3DRangeScan>(written("room.rawlog"));
	ASSERT_EQ(poses.size(), std::size_t(kFrames));
	ASSERT_EQ(scans.size(), std::size_t(kFrames));
	for (int i = 0; i < kFrames; i++)
	{
		// The log has six digits.
		EXPECT_LT((poses[i].pose - cameraAt(i)).norm(), 1e-5) << i;
		const auto relative = poses[i].pose - cameraAt(i);
		EXPECT_LT(
			(relative.getRotationMatrix().asEigen() - Eigen::Matrix3d::Identity()).norm(), 1e-5);
		EXPECT_LT(std::abs(mrpt::system::timeDifference(poses[i].time, scans[i]->timestamp)), 1e-6);
		EXPECT_NEAR(mrpt::Clock::toDouble(scans[i]->timestamp), 1600000000.5 + i / 30.0, 1e-4);
	}
	EXPECT_FALSE(fs::exists(written("room_truth_instances.rawlog")));
	EXPECT_FALSE(fs::exists(written("room_objects.json")));
}

TEST_F(SceneNn2Rawlog, DepthIsTheRecordingsBitByBit)
{
	for (const std::string embed : {"", "--embed"})
	{
		ASSERT_EQ(run(embed).code, 0);
		EXPECT_FALSE(fs::exists(written("room_groundtruth.tum")));
		const auto scans = readAll<CObservation3DRangeScan>(written("room.rawlog"));
		ASSERT_EQ(scans.size(), std::size_t(kFrames));
		for (int i = 0; i < kFrames; i++)
		{
			const auto expected = scanOf(viewOf(i), i);
			scans[i]->load();
			EXPECT_EQ(scans[i]->sensorLabel, "RGBD");
			EXPECT_FLOAT_EQ(scans[i]->rangeUnits, 0.001F);
			EXPECT_NEAR(scans[i]->cameraParams.fx(), 131.25, 1e-6);
			EXPECT_EQ(scans[i]->rangeImage, expected.rangeImage) << i;
			if (embed.empty()) continue;
			cv::Mat difference;
			cv::absdiff(
				scans[i]->intensityImage.asCvMatRef(), expected.intensityImage.asCvMatRef(),
				difference);
			EXPECT_EQ(cv::countNonZero(difference.reshape(1)), 0) << i;
		}
		for (const auto& scan : scans)
			EXPECT_EQ(scan->rangeImage_isExternallyStored(), embed.empty());
		if (!embed.empty())
		{
			EXPECT_EQ(readBytes(written("room_Images/depth_000007.bin")), "of a run before");
			break;
		}
		EXPECT_TRUE(fs::exists(written("room_Images/depth_000007.bin")));
		fs::remove_all(written("room_Images"));
		fs::create_directories(written("room_Images"));
		std::ofstream(written("room_Images/depth_000007.bin")) << "of a run before";
	}
}

TEST_F(SceneNn2Rawlog, TheCameraIsSceneNnsUnlessAnotherIsGiven)
{
	mrpt::img::TCamera xtion = synthetic::makeCamera(640, 480, 544.47329);
	xtion.cx(320);
	xtion.cy(240);
	record("record", "vga.oni", 2, xtion);
	const auto log = folder_.write("two.log", trajectoryLog(2));
	const auto result = runWith(
		"--trajectory " + quoted(log) + " --annotation " + given("076.xml") + " --mesh " +
		given("076.ply") + " " + given("vga.oni") + " room.rawlog");
	ASSERT_EQ(result.code, 0) << result.err;
	const auto camera =
		readAll<CObservation3DRangeScan>(written("room.rawlog")).at(0)->cameraParams;
	EXPECT_EQ(camera.intrinsicParams, xtion.intrinsicParams);
	const auto frames = readAll<CObservationInstances>(written("room_truth_instances.rawlog"));
	ASSERT_EQ(frames.size(), 2U);
	const auto chair = byTrueObject(*frames[1]).at(kChairLabel);
	// Four times the pixels of the others, at the same distance from the true edge.
	EXPECT_GT(intersectionOverUnion(chair->mask, viewOf(1, xtion).masks[kChair]), 0.985);
}

TEST_F(SceneNn2Rawlog, TheObjectsAreTheBoxesOfTheMesh)
{
	ASSERT_EQ(runAnnotated().code, 0);
	const auto graph = SemanticGraph::load(written("room_objects.json"));
	ASSERT_EQ(graph.vertices.size(), 4U);
	const auto find = [&](uint32_t id)
	{
		return *std::find_if(
			graph.vertices.begin(), graph.vertices.end(),
			[&](const auto& v) { return v.id == id; });
	};
	const auto table = find(kTableLabel);
	EXPECT_EQ(table.label, "coffee table");
	EXPECT_LT((table.position - mrpt::math::TPoint3D(0.1, 0.8, 0.2)).norm(), 1e-5);
	EXPECT_LT((*table.extent - mrpt::math::TVector3D(0.8, 0.5, 0.4)).norm(), 1e-5);
	EXPECT_EQ(table.observations, kFrames);
	// Turned by 0.3 rad about z.
	const double side = 0.4 * (std::cos(0.3) + std::sin(0.3));
	const auto chair = find(kChairLabel);
	EXPECT_LT((*chair.extent - mrpt::math::TVector3D(side, side, 0.6)).norm(), 1e-5);
	EXPECT_TRUE(fs::exists(written("room_objects/17_coffee-table.ply")));
}

TEST_F(SceneNn2Rawlog, FramesWhoseCameraWasLostHaveNoTruth)
{
	std::string log;
	for (int i = 0; i < kFrames - 1; i++)  // nor has the last
		log += i == 2 ? lostBlock(i) : block(i, cameraAt(i));
	const auto result = runAnnotated("", folder_.write("lost.log", log));
	ASSERT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.out, HasSubstr("6 frames with a pose"));
	EXPECT_EQ(
		readAll<CObservation3DRangeScan>(written("room.rawlog")).size(), std::size_t(kFrames));
	const auto poses = readTumTrajectory(written("room_groundtruth.tum"));
	const auto truth = readAll<CObservationInstances>(written("room_truth_instances.rawlog"));
	ASSERT_EQ(poses.size(), 6U);
	ASSERT_EQ(truth.size(), 6U);
	EXPECT_LT((poses[2].pose - cameraAt(3)).norm(), 1e-5);
	EXPECT_EQ(SemanticGraph::load(written("room_objects.json")).vertices[0].observations, 6);
}

TEST_F(SceneNn2Rawlog, ExcludedTextsAreNoInstances)
{
	ASSERT_EQ(runAnnotated("--exclude floor --exclude wall --exclude chair").code, 0);
	for (const auto& frame : readAll<CObservationInstances>(written("room_truth_instances.rawlog")))
	{
		EXPECT_EQ(frame->labels.names(), std::vector<std::string>{"coffee table"});
		EXPECT_EQ(frame->instances.size(), 1U);
	}
}

TEST_F(SceneNn2Rawlog, SemloopEvalTakesTheTruth)
{
	ASSERT_EQ(runAnnotated("--exclude floor --exclude wall").code, 0);
	// A run that made no error: its objects 1 and 2 are the chair and the table.
	fs::create_directories(written("OUT"));
	fs::copy(written("room_groundtruth.tum"), written("OUT/trajectory.tum"));
	std::ostringstream associations;
	associations << "time,frame,instance,x,y,w,h,object,first_object\n";
	const auto frames = readAll<CObservationInstances>(written("room_truth_instances.rawlog"));
	const auto poses = readTumTrajectory(written("room_groundtruth.tum"));
	for (std::size_t i = 0; i < frames.size(); i++)
		for (std::size_t k = 0; k < frames[i]->instances.size(); k++)
		{
			const auto& instance = frames[i]->instances[k];
			const int object = *instance.trueObject == kChairLabel ? 1 : 2;
			associations << mrpt::format("%.6f", mrpt::Clock::toDouble(poses[i].time)) << "," << i
						 << "," << k << "," << instance.box.x << "," << instance.box.y << ","
						 << instance.box.width << "," << instance.box.height << "," << object << ","
						 << object << "\n";
		}
	folder_.write("OUT/associations.csv", associations.str());
	folder_.write(
		"OUT/objects.json",
		R"({"format": "semloop.graph/1", "objects": [
		   {"id": 1, "label": "chair", "position": [0, 0, 0.3], "extent": [0.5, 0.5, 0.6]},
		   {"id": 2, "label": "coffee table", "position": [0.1, 0.8, 0.25], "extent": [0.8, 0.5, 0.4]}],
		   "edges": []})");
	fs::create_directories(written("OUT/objects"));
	fs::copy(
		written("room_objects/17_coffee-table.ply"), written("OUT/objects/2_coffee-table.ply"));

	const auto eval = [&](const std::string& arguments)
	{
		const auto result = shell(
			"timeout 60 " SEMLOOP_BINARY_DIR "/bin/semloop-eval " + arguments + " --json",
			folder_.path());
		EXPECT_EQ(result.code, 0) << result.err;
		return nlohmann::json::parse(result.out, nullptr, false);
	};
	auto association =
		eval("association OUT --truth room_truth_instances.rawlog --images room.rawlog");
	EXPECT_EQ(association["true_boxes"], 2 * kFrames) << association;
	EXPECT_EQ(association["accuracy"], 1.0) << association;
	// The camera moved along a line, which does not tell the rotation about it.
	auto objects = eval("objects OUT --truth room_objects.json --align none");
	EXPECT_EQ(objects["recall"], 1.0) << objects;
	EXPECT_EQ(objects["label_accuracy"], 1.0) << objects;
	EXPECT_NEAR(objects["centre_error_m"]["max"], 0.05, 1e-4) << objects;
	EXPECT_NEAR(objects["surface"]["distance_m"]["max"], 0.0, 1e-4) << objects;
}

}  // namespace
}  // namespace semloop::test
