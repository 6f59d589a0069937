#include <filesystem>
#include <fstream>

#include "../openni2/VirtualCameraFolder.h"
#include "SemloopSlamFixture.h"
#include "Shell.h"

using namespace semloop;
using namespace semloop::synthetic;
using testing::HasSubstr;
using testing::Not;

namespace
{
/** OpenNI2 unloads its driver for recordings, which leaks: LeakSanitizer finds no name to suppress. */
const std::string kLeakyDriver = "ASAN_OPTIONS=detect_leaks=0 ";

/** semloop-slam --live with the virtual camera, which plays a short recording at ten frames a second. */
class SemloopSlamLive : public SemloopSlamFixture
{
protected:
	SemloopSlamLive()
	{
		RunOptions options;
		options.degrees = 145;
		recorded_ = recordRun(folder_, options);
		std::ofstream(folder_.file("live.ini")) << R"(
[modules]
odometry = semloop::RecordedOdometry
[segmentation]
max_time_difference = 0.045
[tracking]
min_tracked_frames = 2
[live]
start_time = 1000          ; frameTime(0)
stall_after = 0.5
segmentation_queue = 100
mapping_queue = 100
lost_after = 6
[sensor]
driver = COpenNI2Sensor    ; any of MRPT's
width = 160
height = 120
fps = 30
grab_3D_points = false
[recording]
driver = COniFileSensor
file = recorded.oni
process_rate = 100
speed = 1       ; as recorded
[odd]
driver = CNoSuchSensor
)";
	}

	using Settings = std::map<std::string, std::string>;
	/** Of the camera. MRPT opens it first, which takes a second, and then looks at its frames. */
	Settings camera(Settings more = {}) const
	{
		more.insert({{"RATE", "10"}, {"STALL", "0:3"}});
		return more;
	}
	ShellResult live(
		const std::string& rawlog, const Settings& settings, const std::string& more,
		const std::string& limit = "timeout 60") const
	{
		return shell(
			virtualCamera(rawlog, settings) + limit + " '" + kProgram + "' -c live.ini -o result " +
				"--instances room.rawlog --set odometry.file=room_groundtruth.tum " + more,
			folder_.path());
	}
	std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scansOf(const std::string& rawlog) const
	{
		std::vector<mrpt::obs::CObservation3DRangeScan::Ptr> scans;
		RawlogReader reader(rawlog);
		while (const auto observation = reader.next())
			if (auto scan =
					std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation))
				scans.push_back(scan);
		return scans;
	}

	RecordedRun recorded_;
};
}  // namespace

TEST_F(SemloopSlamLive, MapsWhatTheCameraSeesAndRecordsIt)
{
	const auto result =
		live(recorded_.rawlog, camera(), "--live --record kept.rawlog --max-frames 25");
	ASSERT_EQ(result.code, 0) << result.err;
	const auto json = summary();
	EXPECT_EQ(json["ended_by"], "--max-frames");
	EXPECT_EQ(json["rawlog"], "[sensor] COpenNI2Sensor");
	EXPECT_EQ(json["frames"], 25);
	EXPECT_GE(json["frames_segmented"], 15);
	EXPECT_GE(json["objects"], 5);
	EXPECT_EQ(json["live"]["observations_dropped"], 0);
	EXPECT_EQ(json["live"]["frames_unsegmented"], 0);
	EXPECT_GE(json["live"]["observations_grabbed"], 25);
	EXPECT_EQ(json["live"]["observations_not_recorded"], 0);

	const auto kept = scansOf(folder_.file("kept.rawlog")), given = scansOf(recorded_.rawlog);
	ASSERT_GE(kept.size(), 25u);
	EXPECT_EQ(json["live"]["observations_recorded"], kept.size());
	// The camera sees as far as 10 m.
	const auto isSame = [](const auto& seen, const auto& shown)
	{
		const auto a = seen->rangeImage.asEigen(), b = shown->rangeImage.asEigen();
		return a.size() == b.size() && (a.array() == b.array() || b.array() > 10000).all();
	};
	auto from = given.begin();
	for (const auto& scan : kept)
	{
		from =
			std::find_if(from, given.end(), [&](const auto& shown) { return isSame(scan, shown); });
		ASSERT_NE(from, given.end()) << "not a frame of the camera's, or not in order";
		EXPECT_NEAR(
			mrpt::Clock::toDouble(scan->timestamp),
			mrpt::Clock::toDouble(frameTime(int(from - given.begin()))), 0.5);
		++from;
	}
}

TEST_F(SemloopSlamLive, AnUnpluggedCameraEndsTheRunWithEverythingSoFar)
{
	const auto result =
		live(recorded_.rawlog, camera({{"UNPLUG", "12"}}), "--live --record kept.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("[sensor] COpenNI2Sensor: the camera was unplugged"));
	EXPECT_THAT(result.err, HasSubstr("results so far are in result"));
	// OpenNI2 keeps the newest image only: a busy computer may miss some.
	const std::size_t frames = summary()["frames"];
	EXPECT_GE(frames, 8u);
	EXPECT_LE(frames, 12u);
	EXPECT_EQ(summary()["live"]["observations_grabbed"], frames);
	EXPECT_EQ(readTumTrajectory(folder_.file("result/trajectory.tum")).size(), frames);
	EXPECT_EQ(scansOf(folder_.file("kept.rawlog")).size(), frames);
}

TEST_F(SemloopSlamLive, AStallIsReportedAndRecoveredFrom)
{
	const auto result = live(
		recorded_.rawlog, {{"RATE", "10"}, {"STALL", "15:4"}}, "--live sensor --max-frames 16");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.err, HasSubstr("no frame for 0."));
	EXPECT_THAT(result.err, HasSubstr("frames again"));
	EXPECT_EQ(summary()["frames"], 16);
	EXPECT_GE(summary()["live"]["stalls"], 1);
	EXPECT_GE(summary()["live"]["longest_stall_s"], 1.0);
}

TEST_F(SemloopSlamLive, PlaysARecordingOfOpenNI2ToItsEnd)
{
	const auto recorder = shell(
		virtualCamera(recorded_.rawlog, {{"RATE", "10"}}) + kLeakyDriver +
			"timeout 60 '" SEMLOOP_BINARY_DIR "/openni2/oni-recorder' record recorded.oni",
		folder_.path());
	ASSERT_EQ(recorder.code, 0) << recorder.err;
	const auto result = live("", {}, "--live recording", kLeakyDriver + "timeout 60");
	EXPECT_EQ(result.code, 0) << result.err;
	const auto json = summary();
	EXPECT_EQ(json["ended_by"], "end of the recording");
	EXPECT_EQ(json["frames"], recorded_.frames);
	EXPECT_EQ(json["live"]["observations_dropped"], 0);
	EXPECT_GE(json["frames_segmented"], recorded_.frames / 2);
}

TEST_F(SemloopSlamLive, CtrlCEndsItWithAllResults)
{
	const auto result = live(
		recorded_.rawlog, camera({{"RATE", "5"}}), "--live --record kept.rawlog",
		"timeout --foreground --preserve-status -s INT 9");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.err, HasSubstr("stopped by Ctrl-C"));
	const auto json = summary();
	EXPECT_EQ(json["ended_by"], "Ctrl-C");
	EXPECT_GE(json["frames"], 1);
	EXPECT_EQ(json["frames"], json["live"]["observations_grabbed"]);
	EXPECT_EQ(scansOf(folder_.file("kept.rawlog")).size(), json["frames"]);
}

TEST_F(SemloopSlamLive, WithoutACameraItSaysSo)
{
	folder_.write("summary.json", "of an earlier run");
	std::filesystem::create_directory(folder_.file("result"));
	std::filesystem::rename(folder_.file("summary.json"), folder_.file("result/summary.json"));
	const auto result = live("", {}, "--live");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("[sensor] COpenNI2Sensor: no OpenNI2 device; plug one in"));
	EXPECT_THAT(result.err, Not(HasSubstr("exception")));
	// What an earlier run has left stays.
	EXPECT_EQ(readBytes(folder_.file("result/summary.json")), "of an earlier run");
	EXPECT_THAT(result.err, Not(HasSubstr("results")));
}

TEST_F(SemloopSlamLive, WrongUseIsToldWithTheRemedy)
{
	const auto messageOf = [&](const std::string& arguments)
	{
		const auto result = live("", {}, arguments);
		EXPECT_EQ(result.code, 2) << arguments;
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
		return result.err;
	};
	EXPECT_THAT(messageOf("--live camera"), HasSubstr("live.ini: [camera]: no such section"));
	EXPECT_THAT(messageOf("--live odd"), HasSubstr("CNoSuchSensor: no such sensor class"));
	EXPECT_THAT(messageOf("--live -i room.rawlog"), HasSubstr("exclude each other"));
	EXPECT_THAT(messageOf("-i room.rawlog --record x.rawlog"), HasSubstr("--record needs --live"));
	EXPECT_THAT(
		messageOf("--live --record room.rawlog"), HasSubstr("room.rawlog is there already"));
	EXPECT_THAT(messageOf("--live --record result"), HasSubstr("ends in .rawlog"));
	EXPECT_THAT(messageOf("--live camera --record new.rawlog"), HasSubstr("no such section"));
	EXPECT_FALSE(std::filesystem::exists(folder_.file("new.rawlog")));
	EXPECT_FALSE(std::filesystem::exists(folder_.file("new.rawlog.partial")));
	EXPECT_THAT(
		messageOf("--live --set modules.plugins=/nowhere/libsensor.so"),
		HasSubstr("/nowhere/libsensor.so"));
}
