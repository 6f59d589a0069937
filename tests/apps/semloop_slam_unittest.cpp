#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/observations/ExternalImages.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <sstream>

#include "SemloopSlamFixture.h"

using namespace semloop;
using namespace semloop::synthetic;
using testing::HasSubstr;

namespace
{
class SemloopSlam : public SemloopSlamFixture
{
};
}  // namespace

TEST_F(SemloopSlam, MapsARawlogAndWritesItsResults)
{
	const RecordedRun recorded = recordShortRun();
	ASSERT_EQ(run(arguments(recorded)), 0) << messages();
	EXPECT_EQ(summary()["frames"], recorded.frames);
	EXPECT_EQ(summary()["frames_skipped"], 0);
	EXPECT_THAT(readBytes(folder_.file("out")), HasSubstr("9 frames"));
}

TEST_F(SemloopSlam, EveryFileKeyAndStageOfTheResultsIsInTheManual)
{
	const RecordedRun recorded = recordShortRun();
	ASSERT_EQ(run(arguments(recorded) + " --set slam.loop_every_frames=2"), 0) << messages();
	const std::string manual = readBytes(SEMLOOP_SOURCE_DIR "/doc/file-formats.md");
	const auto expectExplained = [&](const std::string& name)
	{ EXPECT_THAT(manual, HasSubstr("`" + name + "`")); };

	for (const auto& entry : std::filesystem::directory_iterator(folder_.file("result")))
		if (entry.is_regular_file()) expectExplained(entry.path().filename().string());
	const auto figures = summary();
	for (const auto& entry : figures.items()) expectExplained(entry.key());
	std::istringstream loops(readBytes(folder_.file("result/loops.jsonl")));
	std::string line;
	ASSERT_TRUE(std::getline(loops, line));
	const auto loop = nlohmann::json::parse(line);
	for (const auto& entry : loop.items()) expectExplained(entry.key());
	std::istringstream stages(readBytes(folder_.file("result/timings.csv")));
	std::getline(stages, line);
	expectExplained(line);
	while (std::getline(stages, line)) expectExplained(line.substr(0, line.find(',')));
}

TEST_F(SemloopSlam, MakesTheOtherMapsOfItsConfiguration)
{
	const RecordedRun recorded = recordShortRun();
	const std::string grid =
		" --set semloop_map.occupancyGrid_count=1 --set "
		"semloop_map_occupancyGrid_00_creationOpts.resolution=";
	ASSERT_EQ(run(arguments(recorded) + grid + "0.05"), 0) << messages();
	for (const char* const file : {"occupancyGrid_00.png", "occupancyGrid_00.gridmap"})
		EXPECT_TRUE(std::filesystem::exists(folder_.file("result/maps/") + file)) << file;
	EXPECT_EQ(run(arguments(recorded) + grid + "0"), 2);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_EQ(run(arguments(recorded) + " --set semloop_map.gridmap_count=1"), 2);
	EXPECT_THAT(messages(), HasSubstr("[semloop_map] gridmap_count: no map 'gridmap'; use one of"));
	EXPECT_EQ(run(arguments(recorded)), 0) << messages();
	EXPECT_FALSE(std::filesystem::exists(folder_.file("result/maps")));
}

TEST_F(SemloopSlam, TheSimpleMapHasItsImagesInside)
{
	const std::filesystem::path images = folder_.path() / "changed_Images";
	std::filesystem::create_directories(images);
	const RecordedRun recorded = recordShortRun();
	cv::Mat first;
	const RecordedRun external = changed(
		recorded,
		[&](int index, mrpt::obs::CObservation3DRangeScan& scan)
		{
			if (index == 0) first = scan.intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
			const std::string name = std::to_string(index) + ".png";
			ASSERT_TRUE(scan.intensityImage.saveToFile((images / name).string()));
			scan.intensityImage.setExternalStorage(name);
			storeDepthExternally(scan, images.string(), std::to_string(index) + ".bin");
		});
	ASSERT_EQ(run(arguments(external, recorded.rawlog)), 0) << messages();
	std::filesystem::remove_all(images);

	mrpt::maps::CSimpleMap map;
	ASSERT_TRUE(map.loadFromFile(folder_.file("result/map.simplemap")));
	ASSERT_GT(map.size(), 0u);
	mrpt::poses::CPose3DPDF::Ptr pose;
	mrpt::obs::CSensoryFrame::Ptr frame;
	map.get(0, pose, frame);
	const auto scan = frame->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
	ASSERT_TRUE(scan);
	EXPECT_FALSE(scan->rangeImage_isExternallyStored());
	EXPECT_EQ(cv::norm(scan->intensityImage.asCvMatRef(), first, cv::NORM_INF), 0);
}

TEST_F(SemloopSlam, StopsAfterMaxFrames)
{
	const RecordedRun recorded = recordShortRun();
	ASSERT_EQ(run(arguments(recorded) + " --max-frames 4"), 0) << messages();
	EXPECT_EQ(summary()["frames"], 4);
	EXPECT_EQ(summary()["ended_by"], "--max-frames");
}

TEST_F(SemloopSlam, ACutRawlogKeepsTheResultsSoFarAndFails)
{
	const RecordedRun recorded = recordShortRun();
	const std::string bytes = readBytes(recorded.rawlog);
	const std::string cut = folder_.write("cut.rawlog", bytes.substr(0, bytes.size() / 2));
	const std::string arguments =
		"-c '" SEMLOOP_SOURCE_DIR "/config_ini/recorded_odometry.ini' -i '" + cut + "' -o '" +
		folder_.file("result") + "' --set 'odometry.file=" + recorded.truth + "' --instances '" +
		recorded.rawlog + "'";
	EXPECT_EQ(run(arguments), 1);
	EXPECT_THAT(messages(), HasSubstr(cut));
	EXPECT_GT(summary()["frames"], 0);
	EXPECT_LT(summary()["frames"], recorded.frames);
}

TEST_F(SemloopSlam, AnOverrideChangesTheRunButNotTheFile)
{
	const RecordedRun recorded = recordShortRun();
	const std::string ini = SEMLOOP_SOURCE_DIR "/config_ini/recorded_odometry.ini";
	const std::string before = readBytes(ini);
	ASSERT_EQ(run(arguments(recorded) + " --set slam.min_observations=1000"), 0) << messages();
	EXPECT_EQ(readBytes(ini), before);
	EXPECT_TRUE(summary()["objects_by_label"].empty());
}

TEST_F(SemloopSlam, WrongUsageExitsWithTwoAndOneLine)
{
	const RecordedRun recorded = recordShortRun();
	for (const char* wrong :
		 {" --set odometry.dirft=1", " --set slam.level=perhaps", " --set nonsense",
		  " --set modules.odometry=semloop::Teleporter", " --set tracing.gate=1",
		  " --max-frames -3", " --set modules.plugins=/no/such.so"})
	{
		EXPECT_EQ(run(arguments(recorded) + wrong), 2) << wrong;
		const std::string text = messages();
		EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
	}
	EXPECT_EQ(run(""), 2);
	EXPECT_EQ(run("--no-such-flag"), 2);
}

TEST_F(SemloopSlam, FilesThatAreNotThereAreNamed)
{
	const RecordedRun recorded = recordShortRun();
	EXPECT_EQ(
		run("-c /no/such.ini -i '" + recorded.rawlog + "' -o '" + folder_.file("r") + "'"), 1);
	EXPECT_THAT(messages(), HasSubstr("/no/such.ini"));
	RecordedRun missing = recorded;
	missing.rawlog = "/no/such.rawlog";
	EXPECT_EQ(run(arguments(missing)), 1);
	EXPECT_THAT(messages(), HasSubstr("/no/such.rawlog"));
}

TEST_F(SemloopSlam, AFolderThatCannotBeWrittenIsNamedBeforeTheWorkBegins)
{
	const RecordedRun recorded = recordShortRun();
	const std::string file = folder_.write("occupied", "a file, not a folder");
	EXPECT_EQ(
		run("-c '" SEMLOOP_SOURCE_DIR "/config_ini/recorded_odometry.ini' -i '" + recorded.rawlog +
			"' -o '" + file + "'"),
		1);
	EXPECT_THAT(messages(), HasSubstr(file));
}

TEST_F(SemloopSlam, ARecordingWithoutOneUsableFrameFails)
{
	RawlogWriter(folder_.file("empty.rawlog")).close();
	RecordedRun recorded;
	recorded.rawlog = folder_.file("empty.rawlog");
	recorded.truth = folder_.write("truth.tum", "1000 0 0 0 0 0 0 1\n");
	EXPECT_EQ(run(arguments(recorded)), 1);
	EXPECT_THAT(messages(), HasSubstr("no usable RGB-D frame"));
	EXPECT_EQ(summary()["frames"], 0);
}

TEST_F(SemloopSlam, HelpIsAnswered)
{
	EXPECT_EQ(run("--help"), 0);
	EXPECT_THAT(readBytes(folder_.file("out")), HasSubstr("--set"));
	EXPECT_EQ(run("--help-config"), 0);
	EXPECT_THAT(readBytes(folder_.file("out")), HasSubstr("[matching_cost]"));
}
