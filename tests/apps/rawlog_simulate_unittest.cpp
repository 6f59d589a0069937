#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <semloop/object_map/SemanticGraph.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/Trajectory.h>

#include <opencv2/core.hpp>

#include "ChildProcess.h"
#include "RawlogSimulateFixture.h"

using namespace semloop;
using testing::HasSubstr;

namespace
{
constexpr std::size_t kFrames = 11;  // 0.8 m at 0.4 m/s, 5 Hz, both ends

using Scan = mrpt::obs::CObservation3DRangeScan;
}  // namespace

TEST_F(RawlogSimulate, WritesWhatTheManualSays)
{
	ASSERT_EQ(run(), 0) << err_;
	EXPECT_EQ(err_, "");
	EXPECT_THAT(out_, HasSubstr("11 frames of 160x120 pixels, 3 objects"));
	std::vector<std::string> names;
	for (const auto& [name, content] : filesOf("x"))
	{
		EXPECT_FALSE(content.empty()) << name;
		if (name.find("_Images/") == std::string::npos) names.push_back(name);
	}
	EXPECT_THAT(
		names, testing::UnorderedElementsAre(
				   ".rawlog", "_groundtruth.tum", "_odometry.tum", "_objects.json",
				   "_truth_instances.rawlog", "_instances.rawlog", "_attribution.txt",
				   "_objects/1_desk.ply", "_objects/2_book.ply", "_objects/3_box.ply"));
	EXPECT_EQ(filesOf("x_Images/").size(), 2 * kFrames);
}

TEST_F(RawlogSimulate, TheScansReadBackAsFrames)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto scans = readAll<Scan>(folder_.file("x.rawlog"));
	const auto truth = readTumTrajectory(folder_.file("x_groundtruth.tum"));
	ASSERT_EQ(scans.size(), kFrames);
	ASSERT_EQ(truth.size(), kFrames);
	for (std::size_t i = 0; i < kFrames; ++i)
	{
		const auto frame = rgbdFrameFrom(*scans[i]);
		EXPECT_EQ(frame.color.size(), cv::Size(160, 120));
		EXPECT_GT(countValidDepth(frame), 160 * 120 / 2);
		EXPECT_GT(cv::mean(frame.color)[1], 30);
		EXPECT_NEAR(mrpt::Clock::toDouble(frame.time), mrpt::Clock::toDouble(truth[i].time), 1e-6);
		EXPECT_EQ(scans[i]->sensorLabel, "RGBD");
	}
}

TEST_F(RawlogSimulate, TheAccelerometerFeelsGravity)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto imus = readAll<mrpt::obs::CObservationIMU>(folder_.file("x.rawlog"));
	ASSERT_EQ(imus.size(), kFrames);
	const double x = imus[0]->get(mrpt::obs::IMU_X_ACC), z = imus[0]->get(mrpt::obs::IMU_Z_ACC);
	// The camera looks 15 degrees down, within its shaking: x, forward, points below the horizon.
	EXPECT_NEAR(x, -9.80665 * std::sin(15 * M_PI / 180), 0.5);
	EXPECT_NEAR(z, 9.80665 * std::cos(15 * M_PI / 180), 0.2);
}

TEST_F(RawlogSimulate, InstancesBelongToTheFrames)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto scans = readAll<Scan>(folder_.file("x.rawlog"));
	for (const std::string kind : {"x_truth_instances.rawlog", "x_instances.rawlog"})
	{
		const auto instances = readAll<CObservationInstances>(folder_.file(kind));
		ASSERT_EQ(instances.size(), kFrames) << kind;
		for (std::size_t i = 0; i < kFrames; ++i)
		{
			EXPECT_NO_THROW(instances[i]->validate());
			EXPECT_EQ(instances[i]->timestamp, scans[i]->timestamp);
			EXPECT_EQ(instances[i]->imageSize(), cv::Size(160, 120));
		}
	}
}

TEST_F(RawlogSimulate, TheObjectsAreWrittenWithHowOftenTheyAreSeen)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto graph = SemanticGraph::load(folder_.file("x_objects.json"));
	const auto truth = readAll<CObservationInstances>(folder_.file("x_truth_instances.rawlog"));
	std::map<std::string, int> seen;
	for (const auto& observation : truth)
		for (const auto& instance : observation->instances)
			++seen[observation->labels.name(instance.label())];
	ASSERT_EQ(graph.vertices.size(), 3u);
	for (const auto& observation : truth)
		for (const auto& instance : observation->instances)
		{
			const auto id = instance.trueObject.value();
			EXPECT_EQ(graph.vertices.at(id - 1).label, observation->labels.name(instance.label()));
		}
	int all = 0;
	for (const auto& vertex : graph.vertices)
	{
		EXPECT_EQ(vertex.observations, seen[vertex.label]) << vertex.label;
		all += vertex.observations;
	}
	EXPECT_GT(all, 0);
	EXPECT_NEAR(graph.vertices[2].position.z, graph.vertices[2].extent.value().z / 2, 1e-5)
		<< "the box stands on the floor";
}

TEST_F(RawlogSimulate, TheAttributionNamesTheCataloguesModelsOnly)
{
	ASSERT_EQ(run("--frames 1"), 0) << err_;
	const auto text = readBytes(folder_.file("x_attribution.txt"));
	EXPECT_THAT(text, HasSubstr("Scopia#wooden_table_office: "));
	EXPECT_THAT(text, testing::Not(HasSubstr("primitive")));
}

TEST_F(RawlogSimulate, TheSameSeedGivesTheSameBytesWhateverTheThreads)
{
	ASSERT_EQ(run("--seed 5 --threads 1", "a.rawlog"), 0) << err_;
	ASSERT_EQ(run("--seed 5 --threads 3", "b.rawlog"), 0) << err_;
	const auto a = filesOf("a"), b = filesOf("b");
	ASSERT_EQ(a.size(), b.size());
	for (const auto& [name, content] : a) EXPECT_TRUE(b.at(name) == content) << name;
}

TEST_F(RawlogSimulate, AnotherSeedGivesAnotherRun)
{
	ASSERT_EQ(run("--seed 5", "a.rawlog"), 0) << err_;
	ASSERT_EQ(run("--seed 6", "b.rawlog"), 0) << err_;
	const auto a = filesOf("a"), b = filesOf("b");
	for (const std::string name :
		 {".rawlog", "_groundtruth.tum", "_odometry.tum", "_objects.json", "_instances.rawlog",
		  "_Images/color_000000.jpg", "_Images/depth_000000.bin"})
		EXPECT_FALSE(a.at(name) == b.at(name)) << name;
}

TEST_F(RawlogSimulate, FramesAndSizeCanBeChosen)
{
	ASSERT_EQ(run("--frames 3 --size 64x48"), 0) << err_;
	const auto scans = readAll<Scan>(folder_.file("x.rawlog"));
	ASSERT_EQ(scans.size(), 3u);
	EXPECT_EQ(rgbdFrameFrom(*scans[2]).color.size(), cv::Size(64, 48));
	EXPECT_EQ(scans[0]->cameraParams.cx(), 31.5);
	for (const std::string name : {"x_groundtruth.tum", "x_odometry.tum"})
		EXPECT_EQ(readTumTrajectory(folder_.file(name)).size(), 3u);
}

TEST_F(RawlogSimulate, EmbeddedImagesNeedNoFolder)
{
	ASSERT_EQ(run("--frames 2 --embed"), 0) << err_;
	EXPECT_TRUE(filesOf("x_Images").empty());
	EXPECT_GT(countValidDepth(rgbdFrameFrom(*readAll<Scan>(folder_.file("x.rawlog")).at(1))), 0);
}

TEST_F(RawlogSimulate, WithoutColourImagesAreBlackAndTheRestIsTheSame)
{
	ASSERT_EQ(run("--frames 2 --no-color", "a.rawlog"), 0) << err_;
	ASSERT_EQ(run("--frames 2", "b.rawlog"), 0) << err_;
	const auto black = rgbdFrameFrom(*readAll<Scan>(folder_.file("a.rawlog")).at(0));
	const auto colored = rgbdFrameFrom(*readAll<Scan>(folder_.file("b.rawlog")).at(0));
	EXPECT_EQ(cv::norm(black.color, cv::NORM_INF), 0);
	EXPECT_EQ(cv::norm(black.depth, colored.depth, cv::NORM_INF), 0);
	EXPECT_TRUE(filesOf("a").at("_instances.rawlog") == filesOf("b").at("_instances.rawlog"));
}

TEST_F(RawlogSimulate, AMissingSceneOrFurnitureFolderIsTold)
{
	const std::string out = " '" + folder_.file("x.rawlog") + "'";
	expectFailure(runWith("none.ini" + out), 1, {"none.ini: no such file", "config_ini/scenes"});
	expectFailure(run("--furniture /nonexistent"), 1, {"/nonexistent", "sweethome3d-furniture"});
}

TEST_F(RawlogSimulate, WrongScenesAreNamedWithTheirPlace)
{
	expectFailureOf(
		"Scopia#wooden_table_office", "Scopia#woden_table_office", 1,
		{"[desk] models", "similar ones: Scopia#wooden_table_office"});
	expectFailureOf("rate = 5", "rite = 5", 2, {"den.ini: [camera] rite: unknown key"});
	expectFailureOf(
		"desk + book", "desk + book, desk, desk, desk, desk, desk, desk, desk", 1,
		{"[room.den] furniture: 'desk'", "no place"});
	expectFailureOf("1.3 0.6", "4.5 0.6", 1, {"den.ini: [path]", "wall", "0.60)"});
	expectFailureOf("desk + book", "desk + boook", 2, {"[room.den] furniture", "'boook'"});
	expectFailureOf(
		"primitive:book", "primitive:boook", 1,
		{folder_.file("models.ini") + ": [book] models: no primitive 'boook'", "keyboard"});
	scene_ = "/bin/ls";
	expectFailure(run(), 1, {"/bin/ls: cannot be read", "ini file"});
	EXPECT_TRUE(filesOf("x").empty());
}

TEST_F(RawlogSimulate, WrongUsageExitsWith2)
{
	for (const std::string size :
		 {"big", "640", "640x", "640x480x3", "0x0", "-5x20", "99999x99999"})
		expectFailure(run("--size " + size), 2, {});
	expectFailure(run("--size big"), 2, {"--size big", "320x240"});
	expectFailure(run("--frames x"), 2, {});
	expectFailure(run("--set nonsense"), 2, {"--set nonsense"});
	expectFailure(run("--set camera.wdth=3"), 2, {"[camera] wdth"});
	for (const std::string option :
		 {"--frames -1", "--frames 0", "--seed -1", "--seed 536870912", "--threads -1",
		  "--threads 0", "--threads 257"})
		expectFailure(run(option), 2, {option, "use "});
	const std::string at = "den.ini: [";
	for (const auto& [set, section] : std::vector<std::pair<std::string, std::string>>{
			 {"minimum_range=7", "depth_sensor"},
			 {"embedding_size=5", "detector"},
			 {"embedding_class=0.9", "detector"},
			 {"confusions=desk", "detector"}})
		expectFailure(run("--set " + section + "." + set), 2, {at + section + "]"});
	EXPECT_TRUE(filesOf("x").empty());
}

TEST_F(RawlogSimulate, AnUnwritablePlaceIsTold)
{
	expectFailure(
		runWith("'" + scene_ + "' /nonexistent/x.rawlog"), 1,
		{"/nonexistent/x", "cannot be written"});
	std::filesystem::create_directory(folder_.file("folder.rawlog"));
	expectFailure(run("", "folder.rawlog"), 1, {"folder.rawlog", "give one"});
	expectFailure(runWith("'" + scene_ + "' ''"), 1, {"give one"});
}

TEST_F(RawlogSimulate, AShorterRunReplacesALongerOneAndNothingElse)
{
	ASSERT_EQ(run(), 0) << err_;
	std::filesystem::create_directories(folder_.file("x_objects"));
	folder_.write("x_objects/mine.txt", "mine");
	folder_.write("x_objects/9_chair.ply", "of another scene");
	ASSERT_EQ(run("--frames 3"), 0) << err_;
	EXPECT_EQ(filesOf("x_Images/").size(), 6u);
	EXPECT_EQ(filesOf("x_objects/").count("mine.txt"), 1u);
	EXPECT_EQ(filesOf("x_objects/").size(), 4u);
}

TEST_F(RawlogSimulate, AKilledRunLeavesNoEarlierRawlogWithItsImages)
{
	ASSERT_EQ(run("--frames 3"), 0) << err_;
	const auto sizeOfPartial = [&]
	{
		std::error_code none;
		const auto size = std::filesystem::file_size(folder_.file("x.rawlog.partial"), none);
		return none ? 0 : size;
	};
	ChildProcess program(
		{kProgram, scene_, folder_.file("x.rawlog"), "--set", "camera.rate=240", "--set",
		 "path.speed=0.05"},
		folder_.file("out"), folder_.file("err"));
	waitUntil(
		"a few frames are written", [&] { return sizeOfPartial() > 0 || !program.isRunning(); });
	program.send(SIGKILL);
	EXPECT_EQ(program.killedBy(), SIGKILL);
	EXPECT_FALSE(std::filesystem::exists(folder_.file("x.rawlog")));
}

TEST_F(RawlogSimulate, CtrlCFinishesTheFilesOfWhatIsDone)
{
	const std::string images = folder_.file("x_Images");
	ChildProcess program(
		{kProgram, scene_, folder_.file("x.rawlog"), "--set", "camera.rate=240", "--set",
		 "path.speed=0.05", "--threads", "2"},
		folder_.file("out"), folder_.file("err"));
	waitUntil(
		"a few frames are written", [&]
		{ return std::filesystem::exists(images + "/depth_000004.bin") || !program.isRunning(); });
	program.send(SIGINT);
	EXPECT_EQ(program.exitCode(), 0) << readBytes(folder_.file("err"));
	const auto frames = readAll<Scan>(folder_.file("x.rawlog")).size();
	EXPECT_GE(frames, 4u);
	EXPECT_LT(frames, 3841u) << "16 s at 240 Hz";
	EXPECT_EQ(readAll<CObservationInstances>(folder_.file("x_instances.rawlog")).size(), frames);
	EXPECT_EQ(readTumTrajectory(folder_.file("x_groundtruth.tum")).size(), frames);
	EXPECT_THAT(readBytes(folder_.file("out")), HasSubstr(std::to_string(frames) + " frames"));
	EXPECT_EQ(SemanticGraph::load(folder_.file("x_objects.json")).vertices.size(), 3u);
}
