#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservationComment.h>
#include <semloop/sensors/COniFileSensor.h>
#include <semloop/sensors/SensorSource.h>

#include "CameraFixture.h"

namespace semloop::test
{
namespace
{
using mrpt::hwdrivers::CGenericSensor;
using testing::HasSubstr;

class OniFileSensor : public CameraFixture
{
protected:
	/** As a grabber makes it, ready to be asked. */
	CGenericSensor::Ptr sensor(const std::string& settings) const
	{
		const mrpt::config::CConfigFileMemory config(
			"[camera]\nsensorLabel = RGBD\nprocess_rate = 100\n" + settings);
		auto made = CGenericSensor::createSensorPtr("COniFileSensor");
		EXPECT_TRUE(made);
		made->loadConfig(config, "camera");
		made->initialize();
		return made;
	}

	static std::vector<CObservation3DRangeScan::Ptr> take(CGenericSensor& sensor)
	{
		std::vector<CObservation3DRangeScan::Ptr> scans;
		for (const auto& [time, object] : sensor.getObservations())
			if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(object))
				scans.push_back(scan);
		return scans;
	}
};

TEST_F(OniFileSensor, GivesAFrameATimeAtFullSpeedAndTellsItsEnd)
{
	const auto played = sensor("speed = 0\nfile = " + record());
	const auto& recorded = dynamic_cast<const RecordedSensor&>(*played);
	for (int i = 0; i < kFrames; i++)
	{
		ASSERT_FALSE(recorded.isAtEnd());
		played->doProcess();
		EXPECT_EQ(framesOf(take(*played)), std::vector<int>{i});
	}
	EXPECT_TRUE(recorded.isAtEnd());
}

TEST_F(OniFileSensor, TakesItsTimeAsItWasRecordedOrAsToldTo)
{
	using Clock = std::chrono::steady_clock;
	const std::string file = "\nfile = " + record();
	// The last frame comes 290 ms behind the first.
	for (const auto& [speed, least] : {std::pair("1", 290), std::pair("0.5", 580)})
	{
		const auto played = sensor("speed = " + std::string(speed) + "   ; a comment" + file);
		const auto& recorded = dynamic_cast<const RecordedSensor&>(*played);
		const auto start = Clock::now();
		for (played->doProcess(); !recorded.isAtEnd(); played->doProcess())
			std::this_thread::sleep_for(std::chrono::milliseconds(1));
		EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(least - 5)) << speed;
		EXPECT_EQ(framesOf(take(*played)), framesFromTo(0, kFrames - 1));
	}
}

TEST_F(OniFileSensor, KeepsEveryFrameForAGrabberThatComesLate)
{
	const auto played = sensor("speed = 0\nfile = " + record());
	for (int i = 0; i < kFrames; i++) played->doProcess();
	EXPECT_EQ(framesOf(take(*played)), framesFromTo(0, kFrames - 1));
}

TEST_F(OniFileSensor, ThrowsAtTheEndOnceItsLastFrameIsSafe)
{
	const auto played = sensor("speed = 0\nfile = " + record("record", {{"UNPLUG", "3"}}));
	for (int i = 0; i < 3; i++) played->doProcess();
	auto scans = take(*played);
	ASSERT_EQ(scans.size(), 3u);
	EXPECT_NO_THROW(played->doProcess());
	const auto after = played->getObservations();
	ASSERT_EQ(after.size(), 1u);
	EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(after.begin()->second));
	EXPECT_GT(after.begin()->first, scans.back()->timestamp);
	EXPECT_NO_THROW(played->doProcess());
	scans.clear();
	EXPECT_THAT(
		messageOf<InputError>([&] { played->doProcess(); }), HasSubstr("played to its end"));
}

TEST_F(OniFileSensor, TellsACutRecordingFromItsEndAfterTheFramesBefore)
{
	const auto played = sensor("speed = 0\nfile = " + recordAndKill());
	const auto& recorded = dynamic_cast<const RecordedSensor&>(*played);
	std::vector<int> frames;
	const std::string message = messageOf<InputError>(
		[&]
		{
			while (!recorded.isAtEnd())
			{
				played->doProcess();
				for (const int frame : framesOf(take(*played))) frames.push_back(frame);
			}
		});
	EXPECT_THAT(message, HasSubstr("killed.oni: cut or damaged after image "));
	ASSERT_GT(frames.size(), 1u);
	EXPECT_EQ(frames, framesFromTo(0, int(frames.size()) - 1));
}

TEST_F(OniFileSensor, TakesIntrinsicsFromAFile)
{
	const std::string file = folder_.write(
		"xtion.ini",
		"[CAMERA_PARAMS]\nresolution = [64 48]\nfx = 60\nfy = 61\ncx = 30\ncy = 20\ndist = [0 0 0 "
		"0 0]\n");
	const std::string settings = "camera_file = " + file + "\nspeed = 0\nfile = " + record();
	auto played = sensor(settings);
	played->doProcess();
	const auto scans = take(*played);
	ASSERT_EQ(scans.size(), 1u);
	EXPECT_EQ(scans[0]->cameraParams.fx(), 60);
	EXPECT_EQ(scans[0]->cameraParamsIntensity.cy(), 20);

	folder_.write(
		"xtion.ini",
		"[CAMERA_PARAMS]\nresolution = [640 480]\nfx = 600\nfy = 600\ncx = 300\ncy = 200\ndist = "
		"[0 0 0 0 0]\n");
	played.reset();
	EXPECT_THAT(
		messageOf<InputError>([&] { sensor(settings); }),
		HasSubstr("images of 64x48 pixels where the camera has 640x480"));
}

TEST_F(OniFileSensor, WrongKeysAreWrongUsageBeforeTheSensorStarts)
{
	const auto usageErrorOf = [](const std::string& settings)
	{
		const mrpt::config::CConfigFileMemory config(
			"[camera]\ndriver = COniFileSensor\nsensorLabel = RGBD\nprocess_rate = 100\n"
			"max_queue_len = 9\ngrab_decimation = 1\n" +
			settings);
		return messageOf<UsageError>(
			[&] { SensorSource(config, "camera", SensorSourceOptions(), nullptr, nullptr); });
	};
	const std::string twoSections = folder_.write("two.ini", "[A]\na = 1\n[B]\nb = 1\n");
	for (const auto& [settings, saying] : std::vector<std::pair<std::string, std::string>>{
			 {"sped = 0", "[camera]: COniFileSensor: sped: unknown key"},
			 {"speed = fast",
			  "[camera]: COniFileSensor: speed = fast: not allowed; use number in [0, 1000]"},
			 {"pose_yaw = 1e9", "pose_yaw = 1e9: not allowed"},
			 {"start_time = noon", "start_time = noon: must be a Unix time"},
			 {"camera_file = none.ini",
			  "COniFileSensor: camera_file: none.ini: no such file: give a camera"},
			 {"camera_file = " + twoSections, "two.ini: needs a section [CAMERA_PARAMS]"}})
		EXPECT_THAT(usageErrorOf("file = x.oni\n" + settings + "\n"), HasSubstr(saying));
	EXPECT_THAT(usageErrorOf("speed = 1\n"), HasSubstr("COniFileSensor: file: missing"));
}

TEST(OniFileSensorManual, ItsTableIsTheOptions)
{
	EXPECT_THAT(
		readBytes(SEMLOOP_SOURCE_DIR "/doc/live.md"),
		HasSubstr("\n\n" + COniFileSensorOptions().markdownTable()));
}

}  // namespace
}  // namespace semloop::test
