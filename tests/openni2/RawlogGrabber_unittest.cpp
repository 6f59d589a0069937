#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/UnixTime.h>

#include "../mrpt_programs/MrptPrograms.h"
#include "CameraFixture.h"

namespace semloop::test
{
namespace
{
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/** Debian's rawlog-grabber, unmodified. */
class RawlogGrabber : public CameraFixture
{
protected:
	void SetUp() override
	{
		const std::string whyNot = whyNotRunnable("rawlog-grabber");
		if (!whyNot.empty()) GTEST_SKIP() << whyNot;
		// Nothing ever comes from it: the grabber stops at anything that it can read, even the end.
		ASSERT_EQ(shell("mkfifo silence", folder_.path()).code, 0);
	}

	void writeIni(const std::string& camera, int grabberPeriod = 10) const
	{
		folder_.write(
			"grab.ini",
			// OpenNI2 is in the folder of its drivers for a moment, with the whole process.
			"[global]\nrawlog_prefix = " + folder_.file("grabbed") +
				"\ntime_between_launches = 0\nuse_sensoryframes = 0\nGRABBER_PERIOD_MS = " +
				std::to_string(grabberPeriod) +
				"\n[camera]\nsensorLabel = RGBD\nprocess_rate = 200\n" + camera);
	}

	/** Plays recorded.oni, and returns what the grabber printed. */
	std::string playRecording() const
	{
		const auto result = shell(
			"timeout 60 rawlog-grabber -p '" SEMLOOP_BINARY_DIR
			"/lib/libsemloop-sensors.so' grab.ini <> silence",
			folder_.path());
		EXPECT_EQ(result.code, 0) << result.out << result.err;
		return result.out + result.err;
	}

	std::string grabbed() const
	{
		for (const auto& entry : fs::directory_iterator(folder_.path()))
			if (entry.path().extension() == ".rawlog" &&
				entry.path().filename().string().rfind("grabbed_", 0) == 0)
				return entry.path().string();
		return "no rawlog was grabbed";
	}
};

TEST_F(RawlogGrabber, GrabsFromTheVirtualCamera)
{
	writeIni(
		"driver = COpenNI2Sensor\nwidth = 64\nheight = 48\nfps = 30\ngrab_image = true\n"
		"grab_depth = true\ngrab_3D_points = false\n");
	// MRPT sleeps for a second after it has started the streams, and waits for ever for a camera that is
	// gone: this one waits for it, and outlives it.
	const auto result = shell(
		"(sleep 7; echo stop) | " +
			virtualCamera("camera.rawlog", {{"RATE", "4"}, {"STALL", "3:3"}}) +
			"timeout 60 rawlog-grabber grab.ini",
		folder_.path());
	EXPECT_EQ(result.code, 0) << result.out << result.err;
	const auto scans = scansIn(grabbed());
	EXPECT_GE(scans.size(), 5u) << result.out << result.err;
	int before = -1;
	for (const auto& scan : scans)
	{
		EXPECT_FLOAT_EQ(scan->rangeUnits, 1e-3f);
		EXPECT_NEAR(scan->cameraParamsIntensity.fx(), 52.5, 1e-4);
		const int frame = frameOfColor(scan->intensityImage.asCvMatRef());
		EXPECT_GT(frame, before);
		EXPECT_GE(frameOfDepth(storedDepth(*scan)), 0);
		before = frame;
	}
}

TEST_F(RawlogGrabber, PlaysARecordingAndEndsWithAllOfItsFrames)
{
	record();
	writeIni(
		"driver = COniFileSensor\nfile = recorded.oni\nspeed = 0\nstart_time = 1305031453.25\n"
		"pose_z = 1.5\npose_yaw = 90\n");
	EXPECT_THAT(playRecording(), HasSubstr("recorded.oni: played to its end"));
	const auto scans = scansIn(grabbed());
	EXPECT_EQ(framesOf(scans), framesFromTo(0, kFrames - 1));
	ASSERT_EQ(scans.size(), std::size_t(kFrames));
	EXPECT_EQ(formatUnixTime(scans[0]->timestamp), "1305031453.250000");
	EXPECT_EQ(formatUnixTime(scans[7]->timestamp), "1305031453.320000");
	EXPECT_EQ(scans[0]->sensorLabel, "RGBD");
	EXPECT_EQ(scans[0]->sensorPose.z(), 1.5);
	EXPECT_NEAR(scans[0]->sensorPose.yaw(), M_PI / 2, 1e-12);
	EXPECT_FLOAT_EQ(scans[0]->rangeUnits, 1e-3f);
	EXPECT_EQ(countValidDepth(rgbdFrameFrom(*scans[3])), cv::countNonZero(depthOfFrame(3)));
}

TEST_F(RawlogGrabber, GetsAllFramesHoweverSeldomItWrites)
{
	record();
	writeIni("driver = COniFileSensor\nfile = recorded.oni\nspeed = 0\n", 400);
	playRecording();
	EXPECT_EQ(framesOf(scansIn(grabbed())), framesFromTo(0, kFrames - 1));
}

TEST_F(RawlogGrabber, GetsAllFramesBeforeACut)
{
	recordAndKill();
	writeIni("driver = COniFileSensor\nfile = killed.oni\nspeed = 0\n");
	EXPECT_THAT(playRecording(), HasSubstr("killed.oni: cut or damaged after image "));
	const auto frames = framesOf(scansIn(grabbed()));
	ASSERT_GT(frames.size(), 1u);
	EXPECT_EQ(frames, framesFromTo(0, int(frames.size()) - 1));
}

TEST_F(RawlogGrabber, PlaysARecordingAsFastAsItWasRecorded)
{
	record();
	writeIni("driver = COniFileSensor\nfile = recorded.oni\n");
	const auto begin = mrpt::Clock::now();
	playRecording();
	const auto end = mrpt::Clock::now();
	const auto scans = scansIn(grabbed());
	EXPECT_EQ(framesOf(scans), framesFromTo(0, kFrames - 1));
	ASSERT_FALSE(scans.empty());
	// The last frame comes 0.29 s after the first, and that with the time of the computer.
	EXPECT_GT(scans.front()->timestamp, begin);
	EXPECT_LT(scans.back()->timestamp, end);
}

TEST_F(RawlogGrabber, SaysInOneLineWhyItCannotPlay)
{
	for (const auto& [camera, message] : std::vector<std::pair<std::string, std::string>>{
			 {"file = none.oni\n", "none.oni: no such file"},
			 {"speed = 1\n", "file: missing; name a recording"},
			 {"file = x.oni\nspeed = fast\n", "speed = fast: not allowed; use number in [0, 1000]"},
			 {"file = x.oni\nspeed = -1\n", "speed = -1: not allowed"},
			 {"file = x.oni\nstart_time = noon\n", "start_time = noon: must be a Unix"}})
	{
		writeIni("driver = COniFileSensor\n" + camera);
		EXPECT_THAT(playRecording(), HasSubstr(message));
	}
}

TEST_F(RawlogGrabber, WithoutThePlugInDoesNotKnowTheSensor)
{
	writeIni("driver = COniFileSensor\nfile = recorded.oni\n");
	const auto result = shell("timeout 60 rawlog-grabber grab.ini <> silence", folder_.path());
	EXPECT_THAT(result.out + result.err, HasSubstr("Class name not recognized: COniFileSensor"));
}

}  // namespace
}  // namespace semloop::test
