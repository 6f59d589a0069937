#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/pose_graph/G2oFile.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "HeldFile.h"
#include "SemloopSlamFixture.h"

using namespace semloop;
using namespace semloop::synthetic;
using testing::HasSubstr;

namespace
{
constexpr int kHeldFrame = 4;

/** The program on a recording of 20 frames; it waits for the colour image of one in the middle. */
class SemloopSlamInterrupted : public SemloopSlamFixture
{
protected:
	SemloopSlamInterrupted()
	{
		RunOptions options;
		options.degrees = 95;
		recorded_ = recordRun(folder_, options);
		const std::string image = folder_.file("held.png");
		const RecordedRun held = changed(
			recorded_,
			[&](int index, mrpt::obs::CObservation3DRangeScan& scan)
			{
				if (index != kHeldFrame) return;
				std::vector<uint8_t> png;
				cv::imencode(".png", scan.intensityImage.asCvMatRef(), png);
				image_ = std::make_unique<HeldFile>(image, std::string(png.begin(), png.end()));
				scan.intensityImage.setExternalStorage(image);
			});
		// With one frame ahead, who reads frame 4 has given frame 2 to the mapping.
		program_ = std::make_unique<ChildProcess>(
			std::vector<std::string>{
				kProgram, "-c", kConfig, "-i", held.rawlog, "-o", result().string(), "--instances",
				recorded_.rawlog, "--set", "odometry.file=" + recorded_.truth, "--set",
				"slam.frames_ahead=1", "--set", "slam.min_observations=1"},
			folder_.file("out"), folder_.file("err"));
		image_->waitForReader(*program_);
	}

	/** Returns when the program has noticed it. */
	void pressCtrlC()
	{
		ASSERT_TRUE(program_->catches(SIGINT));
		program_->send(SIGINT);
		waitUntil("Ctrl-C is noticed", [&] { return !program_->catches(SIGINT); });
	}
	std::filesystem::path result() const { return folder_.path() / "result"; }
	std::string resultFile(const std::string& name) const { return (result() / name).string(); }

	RecordedRun recorded_;
	std::unique_ptr<HeldFile> image_;
	std::unique_ptr<ChildProcess> program_;
};
}  // namespace

TEST_F(SemloopSlamInterrupted, FinishesTheFrameAndWritesEverything)
{
	pressCtrlC();
	EXPECT_TRUE(program_->isRunning()) << "it finishes the frame";
	image_->release();
	EXPECT_EQ(program_->exitCode(), 0) << messages();
	EXPECT_EQ(summary()["ended_by"], "Ctrl-C");
	EXPECT_THAT(messages(), HasSubstr("Ctrl-C"));

	const std::size_t frames = summary()["frames"];
	EXPECT_GE(frames, 3u);
	EXPECT_LE(frames, kHeldFrame + 1u);
	EXPECT_LT(frames, std::size_t(recorded_.frames));
	EXPECT_EQ(readTumTrajectory(resultFile("trajectory.tum")).size(), frames);
	EXPECT_EQ(readTumTrajectory(resultFile("trajectory_odometry.tum")).size(), frames);

	const auto objects = SemanticGraph::load(resultFile("objects.json")).vertices.size();
	EXPECT_GT(objects, 0u);
	const auto map = loadObjectMap(resultFile("map.objmap"));
	EXPECT_EQ(map->objects().size(), summary()["objects"]);
	const auto meshes = std::filesystem::directory_iterator(result() / "objects");
	EXPECT_EQ(std::size_t(std::distance(begin(meshes), end(meshes))), objects);
	CeresPoseGraph graph;
	readG2o(resultFile("pose_graph.g2o"), graph);
	EXPECT_EQ(graph.nodes().size(), summary()["graph_nodes"]);

	mrpt::maps::CSimpleMap keyFrames;
	EXPECT_TRUE(keyFrames.loadFromFile(resultFile("map.simplemap")));
	EXPECT_GT(keyFrames.size(), 0u);
	mrpt::opengl::COpenGLScene scene;
	EXPECT_TRUE(scene.loadFromFile(resultFile("scene.3Dscene")));

	std::istringstream loops(readBytes(resultFile("loops.jsonl")));
	std::size_t tried = 0;
	for (std::string line; std::getline(loops, line); ++tried)
		EXPECT_TRUE(nlohmann::json::parse(line).contains("decision"));
	EXPECT_EQ(tried, summary()["loops_tried"]);
	EXPECT_THAT(
		readBytes(resultFile("timings.csv")), HasSubstr("\nframe," + std::to_string(frames) + ","));
}

TEST_F(SemloopSlamInterrupted, ASecondTimeStopsAtOnce)
{
	pressCtrlC();
	program_->send(SIGINT);
	EXPECT_EQ(program_->killedBy(), SIGINT);
	EXPECT_FALSE(std::filesystem::exists(result() / "summary.json"));
}
