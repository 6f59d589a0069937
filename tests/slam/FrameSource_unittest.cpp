#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/FrameSource.h>

#include <chrono>
#include <thread>

#include "SyntheticRun.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace semloop
{
/** Says that nothing was segmented. */
class NoSegmenter : public Segmenter
{
	DEFINE_MRPT_OBJECT(NoSegmenter, semloop)
public:
	void configure(const mrpt::config::CConfigFileBase&, const std::string&) override {}
	CObservationInstances::Ptr segment(const RgbdFrame&) override { return nullptr; }
};
}  // namespace semloop

IMPLEMENTS_MRPT_OBJECT(NoSegmenter, semloop::Segmenter, semloop)

namespace
{
struct Collected
{
	std::vector<SlamFrame> frames;
	std::vector<std::string> skipped;
	std::string error;
};

Collected readAll(const std::string& rawlog, int framesAhead)
{
	StageTimings timings;
	FrameSource source(
		std::make_unique<RawlogReader>(rawlog), {std::make_shared<NoSegmenter>(), nullptr},
		framesAhead, timings);
	Collected all;
	try
	{
		while (auto frame = source.next()) all.frames.push_back(std::move(*frame));
	}
	catch (const InputError& e)
	{
		all.error = e.what();
	}
	all.skipped = source.takeSkipped();
	return all;
}

View smallView(double degrees)
{
	return renderView(roomScene(8), smallCamera(), cameraOnCircle(degrees));
}

/** A recording in which 'x' is a frame without depth and '.' is one with. */
std::string recordFrames(const TemporaryFolder& folder, const std::string& frames)
{
	const std::string path = folder.file("x.rawlog");
	RawlogWriter writer(path);
	for (std::size_t i = 0; i < frames.size(); ++i)
	{
		View view = smallView(5 * double(i));
		if (frames[i] == 'x') view.frame.depth.setTo(0);
		writer.write(scanOf(view, int(i)));
	}
	writer.close();
	return path;
}
}  // namespace

class FrameSourceTest : public testing::TestWithParam<int>
{
};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutThread, FrameSourceTest, testing::Values(0, 1, 4));

TEST_P(FrameSourceTest, GivesEveryFrameInOrderWithTheInstancesMergedIntoTheRawlog)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 20;
	const RecordedRun run = recordRun(folder, options);
	const Collected all = readAll(run.rawlog, GetParam());
	ASSERT_EQ(all.frames.size(), 5u);
	EXPECT_EQ(all.error, "");
	for (std::size_t i = 0; i < 5; ++i)
	{
		EXPECT_EQ(all.frames[i].rgbd.time, frameTime(int(i)));
		ASSERT_TRUE(all.frames[i].instances);
		EXPECT_GT(all.frames[i].instances->instances.size(), 0u);
	}
	EXPECT_GT(all.frames.back().progress, 0.5);
}

TEST_P(FrameSourceTest, SkipsAFrameWithoutDepthAndSaysSo)
{
	const TemporaryFolder folder;
	const std::string path = recordFrames(folder, ".x.");
	const Collected all = readAll(path, GetParam());
	EXPECT_EQ(all.frames.size(), 2u);
	ASSERT_EQ(all.skipped.size(), 1u);
	EXPECT_NE(all.skipped[0].find("no pixel has a valid depth"), std::string::npos);
	EXPECT_NE(all.skipped[0].find(path), std::string::npos);
}

TEST_P(FrameSourceTest, ADamagedLastFrameIsToldAtTheEnd)
{
	const TemporaryFolder folder;
	const Collected all = readAll(recordFrames(folder, ".x"), GetParam());
	EXPECT_EQ(all.frames.size(), 1u);
	EXPECT_EQ(all.skipped.size(), 1u);
}

TEST(FrameSource, TellsAWarningWithTheFrameBehindItHoweverFarAheadItHasRead)
{
	const TemporaryFolder folder;
	const std::string path = recordFrames(folder, ".x.xx");
	StageTimings timings;
	FrameSource source(
		std::make_unique<RawlogReader>(path), {std::make_shared<NoSegmenter>(), nullptr}, 4,
		timings);
	while (timings.totals()["read"].count < 5)
		std::this_thread::sleep_for(std::chrono::milliseconds(1));
	std::vector<std::size_t> told;
	do told.push_back(source.takeSkipped().size());
	while (source.next());
	told.push_back(source.takeSkipped().size());
	// Before the first frame, with it, with the second, at the end.
	EXPECT_EQ(told, (std::vector<std::size_t>{0, 0, 1, 2}));
}

TEST_P(FrameSourceTest, TimeGoingBackwardsEndsTheRunAfterTheGoodFrames)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	RawlogWriter writer(path);
	for (const int i : {0, 2, 1}) writer.write(scanOf(smallView(5 * i), i));
	writer.close();
	const Collected all = readAll(path, GetParam());
	EXPECT_EQ(all.frames.size(), 2u);
	EXPECT_NE(all.error.find("time goes backwards"), std::string::npos) << all.error;
}

TEST_P(FrameSourceTest, ACutRawlogGivesItsGoodFramesAndThenAnError)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 30;
	const RecordedRun run = recordRun(folder, options);
	const std::string bytes = readBytes(run.rawlog);
	const std::string cut = folder.write("cut.rawlog", bytes.substr(0, bytes.size() / 2));
	const Collected all = readAll(cut, GetParam());
	EXPECT_GT(all.frames.size(), 1u);
	EXPECT_LT(all.frames.size(), std::size_t(run.frames));
	EXPECT_NE(all.error.find(cut), std::string::npos) << all.error;
}

TEST_P(FrameSourceTest, CanBeLeftInTheMiddle)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 60;
	const RecordedRun run = recordRun(folder, options);
	StageTimings timings;
	FrameSource source(
		std::make_unique<RawlogReader>(run.rawlog), {std::make_shared<NoSegmenter>(), nullptr},
		GetParam(), timings);
	EXPECT_TRUE(source.next());
}
