#include <semloop/observations/RgbdFrame.h>
#include <semloop/sensors/OniRecording.h>

#include <chrono>

#include "CameraFixture.h"

namespace semloop::test
{
namespace
{
using std::chrono::microseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/** Which frames come, and when. */
struct Played
{
	std::vector<int> frames;
	std::vector<microseconds> times;
	std::size_t unpairedColor = 0, unpairedDepth = 0;
};

Played play(const std::string& path)
{
	OniRecording recording(path);
	Played played;
	while (const auto frame = recording.next())
	{
		played.frames.push_back(frameOf(frame->color, frame->depth));
		played.times.push_back(frame->time);
	}
	EXPECT_FALSE(recording.next());
	played.unpairedColor = recording.unpairedColor();
	played.unpairedDepth = recording.unpairedDepth();
	return played;
}

class OniRecordings : public CameraFixture
{
};

TEST_F(OniRecordings, PlayWhatTheCameraSawBitByBit)
{
	const auto played = play(record());
	EXPECT_EQ(played.frames, framesFromTo(0, kFrames - 1));
	EXPECT_EQ(played.unpairedColor, 0u);
	EXPECT_EQ(played.unpairedDepth, 0u);
	for (std::size_t i = 0; i < played.times.size(); i++)
		EXPECT_EQ(played.times[i], microseconds(10'000 * i));
}

TEST_F(OniRecordings, TellUnitCameraAndProgress)
{
	OniRecording recording(record());
	EXPECT_FLOAT_EQ(recording.depthUnit(), 1e-3f);
	const auto camera = recording.camera();
	EXPECT_EQ(camera.ncols, 64u);
	EXPECT_EQ(camera.nrows, 48u);
	// The field of view is stored as a float.
	EXPECT_NEAR(camera.fx(), 52.5, 1e-4);
	EXPECT_NEAR(camera.fy(), 53.5, 1e-4);
	EXPECT_EQ(camera.cx(), 31.5);
	EXPECT_EQ(camera.cy(), 23.5);
	double before = 0;
	while (recording.next())
	{
		EXPECT_GE(recording.progress(), before);
		before = recording.progress();
	}
	EXPECT_EQ(before, 1);
}

TEST_F(OniRecordings, MakeScansThatAreRegisteredFrames)
{
	const auto start = mrpt::Clock::fromDouble(1305031453.25);
	OniScans scans(OniRecording(record()), std::nullopt, start);
	for (int i = 0; i < kFrames; i++)
	{
		const auto scan = scans.next();
		ASSERT_TRUE(scan);
		const RgbdFrame frame = rgbdFrameFrom(*scan);
		cv::Mat millimetres;
		frame.depth.convertTo(millimetres, CV_16U, 1000);
		EXPECT_EQ(frameOf(frame.color, millimetres), i);
		EXPECT_EQ(frame.time, start + i * std::chrono::milliseconds(10));
		EXPECT_NEAR(frame.camera.fx(), 52.5, 1e-4);
	}
	EXPECT_FALSE(scans.next());
}

TEST_F(OniRecordings, MakeNoScansForACameraOfAnotherSize)
{
	auto camera = theCamera();
	camera.ncols = 640;
	const std::string path = record();
	EXPECT_THAT(
		messageOf<InputError>([&] { OniScans(OniRecording(path), camera, {}); }),
		AllOf(
			HasSubstr("recorded.oni: images of 64x48 pixels where the camera has 640x48"),
			HasSubstr("camera_file")));
}

TEST_F(OniRecordings, WithoutAnyPairAreRefused)
{
	OniScans scans(
		OniRecording(record("record", {{"RATE", "100"}, {"DROP_COLOR", "1"}})), std::nullopt, {});
	EXPECT_THAT(
		messageOf<InputError>([&] { scans.next(); }),
		HasSubstr("recorded.oni: no colour and depth image in it were taken together"));
}

TEST_F(OniRecordings, CanBePlayedTwiceAtOnceInOneProcess)
{
	const std::string path = record();
	std::filesystem::copy(path, folder_.file("copy.oni"));
	OniRecording a(path), b(folder_.file("copy.oni"));
	for (int i = 0; i < kFrames; i++)
	{
		const auto fromA = a.next(), fromB = b.next();
		ASSERT_TRUE(fromA && fromB);
		EXPECT_EQ(frameOf(fromA->color, fromA->depth), i);
		EXPECT_EQ(frameOf(fromB->color, fromB->depth), i);
	}
}

TEST_F(OniRecordings, LeaveOutWhatTheCameraLost)
{
	// Of every fifth frame, 4, 9, ..., nothing.
	const auto played = play(record("record", {{"RATE", "100"}, {"DROP", "5"}}));
	std::vector<int> expected;
	for (int i = 0; i < kFrames; i++)
		if (i % 5 != 4) expected.push_back(i);
	EXPECT_EQ(played.frames, expected);
	EXPECT_EQ(played.unpairedColor, 0u);
	EXPECT_EQ(played.unpairedDepth, 0u);
}

TEST_F(OniRecordings, PairByTimeWhereIndicesSlip)
{
	const auto played = play(record("record", {{"RATE", "100"}, {"DROP_COLOR", "5"}}));
	std::vector<int> expected;
	for (int i = 0; i < kFrames; i++)
		if (i % 5 != 4) expected.push_back(i);
	EXPECT_EQ(played.frames, expected);
	EXPECT_EQ(played.unpairedColor, 0u);
	EXPECT_EQ(played.unpairedDepth, std::size_t(kFrames / 5));
}

TEST_F(OniRecordings, KnowOfAStall)
{
	const auto played = play(record("record", {{"RATE", "100"}, {"STALL", "10:0.7"}}));
	EXPECT_EQ(played.frames, framesFromTo(0, kFrames - 1));
	ASSERT_EQ(played.times.size(), std::size_t(kFrames));
	EXPECT_EQ(played.times[9], microseconds(90'000));
	EXPECT_EQ(played.times[10], microseconds(800'000));
	EXPECT_EQ(played.times[11], microseconds(810'000));
}

TEST_F(OniRecordings, EndWhereTheCameraWasUnplugged)
{
	EXPECT_EQ(
		play(record("record", {{"RATE", "100"}, {"UNPLUG", "7"}})).frames, framesFromTo(0, 6));
}

TEST_F(OniRecordings, AreTurnedBackWhenMirrored)
{
	EXPECT_EQ(play(record("record-mirrored")).frames, framesFromTo(0, kFrames - 1));
}

TEST_F(OniRecordings, StayMirroredWhenAskedTo)
{
	OniRecording recording(record("record-mirrored"), {true, std::nullopt});
	for (int i = 0; i < kFrames; i++)
	{
		const auto frame = recording.next();
		ASSERT_TRUE(frame);
		cv::Mat color, depth;
		cv::flip(frame->color, color, 1);
		cv::flip(frame->depth, depth, 1);
		EXPECT_EQ(frameOf(color, depth), i);
	}
}

TEST_F(OniRecordings, CanBePairedGreedily)
{
	// Colour images 4, 9, ... are lost; images come every 10 ms.
	OniRecording recording(
		record("record", {{"RATE", "100"}, {"DROP_COLOR", "5"}}), {false, microseconds(33000)});
	std::vector<std::pair<int, int>> pairs;
	while (const auto frame = recording.next())
		pairs.emplace_back(frameOfDepth(frame->depth), frameOfColor(frame->color));
	using Pairs = std::vector<std::pair<int, int>>;
	ASSERT_GE(pairs.size(), 14u);
	pairs.resize(14);
	EXPECT_EQ(
		pairs, (Pairs{
				   {0, 0},
				   {1, 1},
				   {2, 2},
				   {3, 3},
				   {4, 5},
				   {5, 6},
				   {6, 7},
				   {7, 8},
				   {8, 10},
				   {9, 11},
				   {10, 12},
				   {11, 13},
				   {12, 15},
				   {13, 16}}));
}

TEST_F(OniRecordings, WithoutDepthOrColourAreRefused)
{
	const std::string color = record("record-color");
	EXPECT_THAT(
		messageOf<InputError>([&] { OniRecording recording(color); }),
		AllOf(
			HasSubstr("recorded.oni: has no depth images"), HasSubstr("record depth and colour")));
	const std::string depth = record("record-depth");
	EXPECT_THAT(
		messageOf<InputError>([&] { OniRecording recording(depth); }),
		HasSubstr("recorded.oni: has no colour images"));
}

TEST_F(OniRecordings, ThatAreNoneAreRefused)
{
	EXPECT_THAT(
		messageOf<InputError>([&] { OniRecording recording(folder_.file("none.oni")); }),
		HasSubstr("none.oni: no such file"));
	const std::string text = folder_.write("text.oni", "Dear diary\n");
	EXPECT_THAT(
		messageOf<InputError>([&] { OniRecording recording(text); }),
		HasSubstr("text.oni: no recording of OpenNI2"));
	const std::string empty = folder_.write("empty.oni", "");
	EXPECT_THAT(
		messageOf<InputError>([&] { OniRecording recording(empty); }),
		HasSubstr("empty.oni: no recording of OpenNI2"));
}

TEST_F(OniRecordings, ThatWereCutWhenCopiedAreRefused)
{
	const std::string bytes = readBytes(record());
	for (const std::size_t size : {std::size_t(10), std::size_t(500), bytes.size() / 4})
	{
		const std::string cut = folder_.write("cut.oni", bytes.substr(0, size));
		EXPECT_THAT(
			messageOf<InputError>([&] { OniRecording recording(cut); }),
			AllOf(HasSubstr("cut.oni: "), HasSubstr("was cut"), HasSubstr("copy it again")))
			<< size;
	}
}

TEST_F(OniRecordings, WhoseRecorderWasKilledAreGoodUpToThere)
{
	OniRecording recording(recordAndKill());
	int count = 0;
	const std::string message = messageOf<InputError>(
		[&]
		{
			for (; const auto frame = recording.next(); ++count)
				EXPECT_EQ(frameOf(frame->color, frame->depth), count);
		});
	EXPECT_GT(count, 0);
	EXPECT_LE(count, 20);
	EXPECT_THAT(
		message, AllOf(HasSubstr("killed.oni: cut or damaged after image "), HasSubstr("is good")));
}

}  // namespace
}  // namespace semloop::test
