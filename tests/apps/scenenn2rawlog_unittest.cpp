#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/object_map/SemanticGraph.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/Trajectory.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "../openni2/VirtualCameraFolder.h"
#include "Shell.h"
#include "SyntheticScene.h"
#include "TemporaryFolder.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;
using synthetic::Box;
using synthetic::View;
using ::testing::HasSubstr;

constexpr int kFrames = 8;
constexpr double kSpacing = 0.01;  // of the mesh's vertices [m]

// Ids of the shapes, and what the annotation calls them.
constexpr int kRoom = 0, kChair = 1, kTable = 2, kUnnamed = 3, kNotInMesh = 4;
constexpr uint32_t kChairLabel = 8844, kTableLabel = 17, kFloorLabel = 5, kUnnamedLabel = 6,
				   kWallLabel = 7;
const char* const kAnnotation =
	"<?xml version=\"1.0\"?>\n<annotation>\n"
	"  <label id=\"8844\" text=\"chair\" color=\"255 0 0\" nyu_class=\"chair\"/>\n"
	"  <label id=\"17\" text=\" coffee table \" aabbox=\"0 0 0 1 1 1\"/>\n"
	"  <label id=\"5\" text=\"floor\"/>\n"
	"  <label id=\"6\" text=\"\"/>\n"
	"  <label id=\"7\" text=\"wall\"/>\n"
	"  <label id=\"99\" text=\"lamp\"/>\n"
	"</annotation>\n";

/** Two objects, one without a name and one that was put there after the reconstruction. */
std::vector<Box> boxes()
{
	return {
		{CPose3D(0, 0, 0.3, 0.3, 0, 0), {0.4, 0.4, 0.6}, {40, 40, 200}, kChair, 0.1},
		{CPose3D(0.1, 0.8, 0.2, 0, 0, 0), {0.8, 0.5, 0.4}, {40, 200, 40}, kTable, 0.1},
		{CPose3D(0.1, -0.8, 0.2, 0, 0, 0), {0.3, 0.3, 0.4}, {200, 40, 40}, kUnnamed, 0.1},
		{CPose3D(0.4, -0.3, 0.6, 0, 0, 0), {0.2, 0.2, 0.2}, {20, 200, 200}, kNotInMesh, 0.1}};
}

CPose3D cameraAt(int frame)
{
	return synthetic::lookAt({2.0, -0.7 + 0.2 * frame, 1.3}, {0, 0.05 * frame, 0.2});
}

View viewOf(int frame, const mrpt::img::TCamera& camera = synthetic::smallCamera())
{
	synthetic::Scene scene;
	scene.boxes = boxes();
	scene.planes.push_back({{0, 0, 1}, 0, {128, 128, 128}, kRoom, 0.2});
	scene.planes.push_back({{1, 0, 0}, -1.5, {160, 160, 160}, kRoom, 0.2});
	return renderView(scene, camera, cameraAt(frame));
}

/** What the camera delivers [mm]. */
uint16_t storedDepth(float metres)
{
	return cv::saturate_cast<uint16_t>(metres * 1000.0F);
}

CObservation3DRangeScan scanOf(const View& view, int frame)
{
	CObservation3DRangeScan scan;
	scan.timestamp = mrpt::Clock::fromDouble(1000 + frame / 30.0);
	scan.sensorLabel = "RGBD";
	scan.cameraParams = scan.cameraParamsIntensity = view.frame.camera;
	scan.range_is_depth = true;
	scan.rangeUnits = 0.001F;
	scan.hasRangeImage = scan.hasIntensityImage = true;
	scan.rangeImage.resize(view.frame.depth.rows, view.frame.depth.cols);
	for (int v = 0; v < view.frame.depth.rows; v++)
		for (int u = 0; u < view.frame.depth.cols; u++)
			scan.rangeImage(v, u) = storedDepth(view.frame.depth.at<float>(v, u));
	scan.intensityImage = mrpt::img::CImage(view.frame.color, mrpt::img::DEEP_COPY);
	return scan;
}

/** SceneNN's world has y up. */
mrpt::math::TPoint3D toSceneNn(const mrpt::math::TPoint3D& p)
{
	return {p.x, p.z, -p.y};
}

struct Vertex
{
	mrpt::math::TPoint3D p;
	uint32_t label = 0;
};

struct Mesh
{
	std::vector<Vertex> vertices;
	std::vector<std::array<uint32_t, 3>> triangles;

	/** A rectangle from a corner, along two edges. */
	void addRectangle(
		const CPose3D& pose, const mrpt::math::TPoint3D& corner, const mrpt::math::TVector3D& a,
		const mrpt::math::TVector3D& b, uint32_t label)
	{
		const int rows = int(std::ceil(a.norm() / kSpacing));
		const int columns = int(std::ceil(b.norm() / kSpacing));
		const auto first = uint32_t(vertices.size());
		const auto at = [&](int i, int j) { return first + uint32_t(i * (columns + 1) + j); };
		for (int i = 0; i <= rows; i++)
			for (int j = 0; j <= columns; j++)
			{
				const auto p = corner + a * (double(i) / rows) + b * (double(j) / columns);
				vertices.push_back({toSceneNn(pose.composePoint(p)), label});
				if (i == rows || j == columns) continue;
				triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
				triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
			}
	}

	void add(const Box& box, uint32_t label)
	{
		for (int axis = 0; axis < 3; axis++)
			for (const double side : {-0.5, 0.5})
			{
				const int right = (axis + 1) % 3, up = (axis + 2) % 3;
				mrpt::math::TPoint3D corner(0, 0, 0);
				mrpt::math::TVector3D a(0, 0, 0), b(0, 0, 0);
				corner[axis] = side * box.size[axis];
				corner[right] = -0.5 * box.size[right];
				corner[up] = -0.5 * box.size[up];
				a[right] = box.size[right];
				b[up] = box.size[up];
				addRectangle(box.T_world_box, corner, a, b, label);
			}
	}

	/** Binary, with properties round the one that counts. */
	std::string ply(bool withLabels = true) const
	{
		std::ostringstream out;
		out << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices.size()
			<< "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
			<< (withLabels ? "property uint label\n" : "property uint segment\n")
			<< "property float nx\nelement face " << triangles.size()
			<< "\nproperty list uchar int vertex_indices\nend_header\n";
		const auto append = [&](auto value)
		{ out.write(reinterpret_cast<const char*>(&value), sizeof(value)); };
		for (const auto& vertex : vertices)
		{
			for (int axis = 0; axis < 3; axis++) append(float(vertex.p[axis]));
			append(uint8_t(200));
			append(vertex.label);
			append(0.5F);
		}
		for (const auto& triangle : triangles)
		{
			append(uint8_t(3));
			for (const uint32_t corner : triangle) append(int32_t(corner));
		}
		return out.str();
	}
};

Mesh sceneMesh()
{
	Mesh mesh;
	mesh.addRectangle({}, {-4, -4, 0}, {0.001, 0, 0}, {0.001, 0, 0}, 0);  // noise of no label
	mesh.addRectangle({}, {-1.5, -3, 0}, {3, 0, 0}, {0, 6, 0}, kFloorLabel);
	mesh.addRectangle({}, {-1.5, -3, 0}, {0, 6, 0}, {0, 0, 1.4}, kWallLabel);
	mesh.add(boxes()[0], kChairLabel);
	mesh.add(boxes()[1], kTableLabel);
	mesh.add(boxes()[2], kUnnamedLabel);
	return mesh;
}

/** A block of a trajectory.log. */
std::string block(int frame, const CPose3D& T_world_camera)
{
	std::ostringstream out;
	out.precision(7);
	out << frame << " " << frame << " " << frame + 1 << "\n";
	// The columns are the camera's axes in the world, and its place.
	std::array<mrpt::math::TPoint3D, 4> columns;
	for (int i = 0; i < 3; i++)
	{
		mrpt::math::TVector3D axis(0, 0, 0);
		axis[i] = 1;
		const auto turned = T_world_camera.rotateVector(axis);
		columns[i] = toSceneNn({turned.x, turned.y, turned.z});
	}
	columns[3] = toSceneNn(mrpt::math::TPoint3D(T_world_camera.translation()));
	for (int row = 0; row < 3; row++)
	{
		for (const auto& column : columns) out << column[row] << " ";
		out << "\n";
	}
	out << "0.000000 0.000000 0.000000 1.000000\n";
	return out.str();
}

std::string lostBlock(int frame)
{
	std::ostringstream out;
	out << frame << " " << frame << " " << frame + 1 << "\n0 0 0 0.03\n0 0 0 3.1\n0 0 0 -1.4\n"
		<< "0.000000 0.000000 0.000000 1.000000\n";
	return out.str();
}

std::string trajectoryLog(int frames = kFrames)
{
	std::string text;
	for (int i = 0; i < frames; i++) text += block(i, cameraAt(i));
	return text;
}

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

/** The program on a small sequence that is recorded once. */
class SceneNn2Rawlog : public ::testing::Test
{
protected:
	static void SetUpTestSuite()
	{
		sequence_ = std::make_unique<TemporaryFolder>();
		record("record", "076.oni", kFrames, synthetic::smallCamera());
		sequence_->write("076.ply", sceneMesh().ply());
		sequence_->write("076.xml", kAnnotation);
		sequence_->write("trajectory.log", trajectoryLog());
		mrpt::config::CConfigFileMemory camera;
		synthetic::smallCamera().saveToConfigFile("CAMERA_PARAMS", camera);
		sequence_->write("camera.ini", camera.getContent());
	}
	static void TearDownTestSuite() { sequence_.reset(); }

	static void record(
		const std::string& how, const std::string& oni, int frames,
		const mrpt::img::TCamera& camera)
	{
		RawlogWriter writer(sequence_->file("camera.rawlog"));
		for (int i = 0; i < frames; i++) writer.write(scanOf(viewOf(i, camera), i));
		writer.close();
		const auto recorded = shell(
			virtualCamera("camera.rawlog") +
				"timeout 60 " SEMLOOP_BINARY_DIR "/openni2/oni-recorder " + how + " " + oni,
			sequence_->path());
		ASSERT_EQ(recorded.code, 0) << recorded.err;
	}

	static std::string quoted(const std::string& path) { return "'" + path + "'"; }
	static std::string given(const std::string& file) { return quoted(sequence_->file(file)); }
	std::string written(const std::string& file) const { return folder_.file(file); }

	ShellResult runWith(const std::string& arguments) const
	{
		return shell(
			"timeout 120 " SEMLOOP_BINARY_DIR "/bin/scenenn2rawlog " + arguments, folder_.path());
	}
	/** On the recording, with its camera. */
	ShellResult run(const std::string& options) const
	{
		return runWith(
			"--camera " + given("camera.ini") + " " + options + " " + given("076.oni") +
			" room.rawlog");
	}
	/** With trajectory, annotation and mesh, each the sequence's own unless another file is named. */
	ShellResult runAnnotated(
		const std::string& options = "", const std::string& trajectory = "",
		const std::string& annotation = "", const std::string& mesh = "") const
	{
		const auto orOwn = [](const std::string& path, const char* own)
		{ return path.empty() ? given(own) : quoted(path); };
		return run(
			"--trajectory " + orOwn(trajectory, "trajectory.log") + " --annotation " +
			orOwn(annotation, "076.xml") + " --mesh " + orOwn(mesh, "076.ply") + " " + options);
	}

	/** One line that says all this, and no result under its name. */
	void expectError(
		const ShellResult& result, int code, const std::vector<std::string>& says) const
	{
		EXPECT_EQ(result.code, code) << result.err;
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
		for (const auto& words : says) EXPECT_THAT(result.err, HasSubstr(words));
		for (const char* file :
			 {"room.rawlog", "room_truth_instances.rawlog", "room_groundtruth.tum",
			  "room_objects.json"})
			EXPECT_FALSE(fs::exists(written(file))) << file;
	}

	static std::unique_ptr<TemporaryFolder> sequence_;
	const TemporaryFolder folder_;
};

std::unique_ptr<TemporaryFolder> SceneNn2Rawlog::sequence_;

using SceneNn2RawlogBadInput = SceneNn2Rawlog;

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

TEST_F(SceneNn2RawlogBadInput, WrongUsageExitsWith2)
{
	const std::string xml = "--annotation " + given("076.xml"), ply = "--mesh " + given("076.ply"),
					  log = "--trajectory " + given("trajectory.log");
	expectError(run(log + " " + xml), 2, {"--annotation needs", "--mesh"});
	expectError(run(log + " " + ply), 2, {"--mesh is only for", "--annotation"});
	expectError(run(xml + " " + ply), 2, {"--trajectory"});
	expectError(run(log + " --exclude sofa"), 2, {"--annotation"});
	expectError(runAnnotated("--exclude sofa"), 2, {"sofa", "076.xml"});
	for (const char* tolerance : {"0", "nan", "2"})
		expectError(runAnnotated(std::string("--tolerance ") + tolerance), 2, {"tolerance"});
	for (const char* time : {"yesterday", "nan", "0"})
		expectError(run(std::string("--start-time ") + time), 2, {"start-time"});
	expectError(run("--no-such-option"), 2, {"--help"});
	expectError(runWith(given("076.oni")), 2, {});
	expectError(
		runWith("--camera nowhere.ini " + given("076.oni") + " room.rawlog"), 2, {"nowhere.ini"});
	EXPECT_EQ(runWith("--help").code, 0);
}

TEST_F(SceneNn2RawlogBadInput, ACameraWithDistortionIsRefused)
{
	auto camera = synthetic::smallCamera();
	camera.setDistortionPlumbBob(0.1, 0, 0, 0, 0);
	mrpt::config::CConfigFileMemory config;
	camera.saveToConfigFile("CAMERA_PARAMS", config);
	const auto file = folder_.write("distorted.ini", config.getContent());
	expectError(
		runWith("--camera " + quoted(file) + " " + given("076.oni") + " room.rawlog"), 2,
		{"distorted.ini", "distortion"});
}

TEST_F(SceneNn2RawlogBadInput, SceneNnsCameraNeedsItsImageSize)
{
	expectError(
		runWith(given("076.oni") + " room.rawlog"), 1,
		{"076.oni", "160x120", "640x480", "--camera"});
}

TEST_F(SceneNn2RawlogBadInput, MissingFilesAreNamed)
{
	const std::string nowhere = folder_.file("nowhere");
	expectError(runWith("nowhere.oni room.rawlog"), 1, {"nowhere.oni"});
	expectError(runAnnotated("", nowhere), 1, {nowhere});
	expectError(runAnnotated("", "", nowhere), 1, {nowhere});
	expectError(runAnnotated("", "", "", nowhere), 1, {nowhere});
	expectError(
		runWith("--camera " + given("camera.ini") + " " + given("076.oni") + " no/room.rawlog"), 1,
		{"no/room"});
}

TEST_F(SceneNn2RawlogBadInput, ARecordingWithoutDepthIsNamed)
{
	record("record-color", "color.oni", 2, synthetic::smallCamera());
	expectError(
		runWith("--camera " + given("camera.ini") + " " + given("color.oni") + " room.rawlog"), 1,
		{"color.oni", "depth"});
}

TEST_F(SceneNn2RawlogBadInput, ATrajectorysBadLineIsNamed)
{
	const std::string good = block(0, cameraAt(0)), last = "0 0 0 1\n";
	const std::vector<std::tuple<std::string, std::string, std::string>> cases{
		{good + "1 1 2\nnan 0 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:7:", "'nan'"},
		{good + "1 1 2\n1 0 0\n", "bad.log:7:", "3 words"},
		{good + "1 1 2\n2 0 0 0\n0 2 0 0\n0 0 2 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0 0 0\n0 1 0 0\n0 0 -1 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0.1 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:10:", "rigid"},
		{good + "1 1 2\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 2\n", "bad.log:10:", "last row"},
		{good + "1 1 2\n1 0 0 0\n", "bad.log:7:", "ends inside"},
		{good + "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + last, "bad.log:6:", "frame 0"},
		{good + "1 2 3\n", "bad.log:6:", "i i i+1"},
		{good + "99999999999 99999999999 100000000000\n", "bad.log:6:", "frame 99999999999"},
		{"", "bad.log", "no pose"},
		{lostBlock(0), "bad.log", "no pose"}};
	for (const auto& [text, place, problem] : cases)
		expectError(
			run("--trajectory " + quoted(folder_.write("bad.log", text))), 1, {place, problem});
}

TEST_F(SceneNn2RawlogBadInput, ATrajectoryOfAnotherRecordingIsRefused)
{
	const auto longer = folder_.write("longer.log", trajectoryLog(kFrames + 6));
	expectError(
		run("--trajectory " + quoted(longer)), 1, {"longer.log", "frame 13", "only 8", "076.oni"});
	const auto shorter = folder_.write("shorter.log", trajectoryLog(kFrames / 2 - 1));
	expectError(
		run("--trajectory " + quoted(shorter)), 1, {"shorter.log", "3 of the 8", "076.oni"});
	// Players differ in what they pair at the end.
	const auto slightly = folder_.write("slightly.log", trajectoryLog(kFrames + 5));
	EXPECT_EQ(run("--trajectory " + quoted(slightly)).code, 0);
}

TEST_F(SceneNn2RawlogBadInput, AnAnnotationThatIsNoneIsNamedWithItsLine)
{
	const std::vector<std::tuple<std::string, std::string, std::string>> cases{
		{"<annotation>\n<label id=\"1\" text=\"a\"/>\n</wrong>", "bad.xml:3:", "mismatched tag"},
		{"<annotation>\n<label id=\"1\" text=\"a\"/>\n", "bad.xml:3:", "XML"},
		{"", "bad.xml:1:", "XML"},
		{"no XML", "bad.xml:1:", "XML"},
		{"<a>\n<label text=\"a\"/></a>", "bad.xml:2:", "without id"},
		{"<a>\n<label id=\"one\" text=\"a\"/></a>", "bad.xml:2:", "'one'"},
		{"<a>\n<label id=\"-1\" text=\"a\"/></a>", "bad.xml:2:", "'-1'"},
		{"<a>\n<label id=\"4294967296\" text=\"a\"/></a>", "bad.xml:2:", "'4294967296'"},
		{"<a><label id=\"1\" text=\"a\"/>\n<label id=\"1\" text=\"b\"/></a>",
		 "bad.xml:2:", "second time"},
		{"<a><label id=\"1\" text=\" \"/></a>", "bad.xml", "no <label>"}};
	for (const auto& [text, place, problem] : cases)
		expectError(
			runAnnotated("", "", folder_.write("bad.xml", text)), 1, {place, problem, "SceneNN"});
}

TEST_F(SceneNn2RawlogBadInput, AMeshThatCannotBeUsedIsNamed)
{
	const auto expect = [&](const std::string& ply, const std::string& problem) {
		expectError(
			runAnnotated("", "", "", folder_.write("bad.ply", ply)), 1, {"bad.ply", problem});
	};
	const std::string ascii = "ply\nformat ascii 1.0\n", xyz =
															 "property float x\nproperty float y\n"
															 "property float z\n";
	const Mesh mesh = sceneMesh();
	expect(mesh.ply(false), "no property 'label'");
	expect(mesh.ply().substr(0, 5000), "ends early");
	expect("solid\n", "not a PLY file");
	expect(
		ascii + "element vertex 1\n" + xyz + "property int label\nend_header\n0 0 0 -1\n", "label");
	expect(
		ascii + "element vertex 1\n" + xyz + "property float label\nend_header\n0 0 0 1.5\n",
		"label");
	expect(ascii + "element vertex 0\n" + xyz + "property int label\nend_header\n", "no vertices");
	expect(
		ascii + "element face 1\nproperty list uchar int vertex_indices\nend_header\n", "vertices");
	Mesh broken = mesh;
	broken.vertices[1000].p.x = std::nan("");
	expect(broken.ply(), "not finite");
}

TEST_F(SceneNn2RawlogBadInput, AnAnnotationOfAnotherMeshIsRefused)
{
	const auto other = folder_.write(
		"other.xml", "<a><label id=\"1\" text=\"x\"/><label id=\"2\" text=\"y\"/></a>");
	expectError(
		runAnnotated("", "", other), 1, {"other.xml", "none of its 2", "076.ply", "one sequence"});
}

TEST_F(SceneNn2RawlogBadInput, AMeshThatDoesNotFitTheSequenceIsRefusedWithTheShare)
{
	Mesh moved = sceneMesh();
	for (auto& vertex : moved.vertices) vertex.p += mrpt::math::TPoint3D(0.3, 0.3, 0);
	const auto file = folder_.write("moved.ply", moved.ply());
	const auto result = runAnnotated("", "", "", file);
	expectError(result, 1, {"076.xml", "does not fit", "076.oni", "within 0.05 m", "50.0 %"});
	// Only where sides of the moved boxes meet others.
	double share = -1;
	const auto number = result.err.find("only ");
	ASSERT_NE(number, std::string::npos);
	std::istringstream(result.err.substr(number + 5)) >> share;
	EXPECT_GE(share, 0.0);
	EXPECT_LT(share, 30.0);
	EXPECT_EQ(runAnnotated("--tolerance 0.4", "", "", file).code, 0);
}

}  // namespace
}  // namespace semloop
