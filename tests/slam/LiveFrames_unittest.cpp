#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/AssociationRecord.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/FrameSource.h>
#include <semloop/slam/LiveFrames.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "SyntheticRun.h"

using namespace semloop;
using namespace semloop::synthetic;
using namespace std::chrono_literals;
using testing::HasSubstr;

namespace semloop
{
/** Does with each frame what the test wants. */
class ScriptedSegmenter : public Segmenter
{
	DEFINE_MRPT_OBJECT(ScriptedSegmenter, semloop)
public:
	void configure(const mrpt::config::CConfigFileBase&, const std::string&) override {}
	CObservationInstances::Ptr segment(const RgbdFrame& frame) override { return script(frame); }

	std::function<CObservationInstances::Ptr(const RgbdFrame&)> script;
};
}  // namespace semloop

IMPLEMENTS_MRPT_OBJECT(ScriptedSegmenter, semloop::Segmenter, semloop)

namespace
{
/** A recording that fails where a test wants it to, and waits at its end until it is stopped. */
class ScriptedSensor : public ObservationSource
{
public:
	explicit ScriptedSensor(const std::string& rawlog) : reader_(rawlog) {}

	mrpt::obs::CObservation::Ptr next() override
	{
		if (failAfter-- == 0) throw InputError("the cable is broken");
		if (auto observation = reader_.next()) return observation;
		while (waitsAtEnd && !stopped_) std::this_thread::sleep_for(1ms);
		return nullptr;
	}
	void stop() override { stopped_ = true; }
	const std::string& name() const override { return reader_.name(); }
	double progress() const override { return 0; }

	int failAfter = -1;
	bool waitsAtEnd = false;

private:
	RawlogReader reader_;
	std::atomic<bool> stopped_{false};
};

/** Closed until opened. */
class Gate
{
public:
	void open()
	{
		const std::lock_guard lock(mutex_);
		open_ = true;
		opened_.notify_all();
	}
	void pass()
	{
		std::unique_lock lock(mutex_);
		opened_.wait(lock, [&] { return open_; });
	}

private:
	std::mutex mutex_;
	std::condition_variable opened_;
	bool open_ = false;
};

class LiveFramesTest : public testing::Test
{
protected:
	LiveFramesTest()
	{
		logger_.logging_enable_console_output = false;
		RunOptions options;
		options.degrees = 100;
		options.withInstances = false;
		recorded_ = recordRun(folder_, options);
		slam_ = std::make_unique<SemanticSlam>(runConfiguration(recorded_, 0), logger_, timings_);
		sensor_ = std::make_unique<ScriptedSensor>(recorded_.rawlog);
		segmenter_ = ScriptedSegmenter::Create();
		segmenter_->script = [](const RgbdFrame& frame)
		{
			auto instances = CObservationInstances::Create();
			instances->timestamp = frame.time;
			instances->labels = roomLabels();
			instances->camera = frame.camera;
			return instances;
		};
	}

	LiveFrames& start()
	{
		frames_ = std::make_unique<LiveFrames>(
			*sensor_, FrontEnd{segmenter_, nullptr}, *slam_, options_, timings_);
		return *frames_;
	}
	/** Until the end or an error. */
	std::vector<TrackedFrame> readAll(LiveFrames& frames)
	{
		std::vector<TrackedFrame> result;
		try
		{
			while (!frames.hasEnded())
				if (auto frame = frames.next(10ms)) result.push_back(std::move(*frame));
		}
		catch (const std::exception& e)
		{
			error_ = e.what();
		}
		return result;
	}

	TemporaryFolder folder_;
	RecordedRun recorded_;
	mrpt::system::COutputLogger logger_;
	StageTimings timings_;
	LiveOptions options_;
	std::unique_ptr<SemanticSlam> slam_;
	std::unique_ptr<ScriptedSensor> sensor_;
	ScriptedSegmenter::Ptr segmenter_;
	std::unique_ptr<LiveFrames> frames_;
	std::string error_;
};
}  // namespace

TEST_F(LiveFramesTest, ASegmenterThatHangsDoesNotHoldUpTracking)
{
	Gate gate;
	const auto quick = segmenter_->script;
	segmenter_->script = [&](const RgbdFrame& frame)
	{
		gate.pass();
		return quick(frame);
	};
	options_.segmentationQueue = 3;
	LiveFrames& live = start();
	const auto frames = std::size_t(recorded_.frames);
	// All are tracked while the segmenter has the first of them.
	while (live.unsegmented() < frames - 3) std::this_thread::sleep_for(1ms);
	EXPECT_FALSE(live.next(1ms));
	EXPECT_EQ(timings_.summaries()["odometry"].count, frames);
	gate.open();

	const auto all = readAll(live);
	ASSERT_EQ(all.size(), frames);
	for (std::size_t i = 0; i < frames; ++i)
	{
		const SlamFrame& frame = all[i].frame;
		EXPECT_EQ(frame.rgbd.time, frameTime(int(i)));
		EXPECT_EQ(bool(frame.instances), i < 3) << i;
		// What is not to be mapped costs no memory while it waits.
		EXPECT_EQ(frame.rgbd.color.empty(), i >= 3) << i;
		EXPECT_EQ(bool(frame.scan), i < 3) << i;
	}
	EXPECT_EQ(live.unsegmented(), frames - 3);
	EXPECT_EQ(error_, "");
}

TEST_F(LiveFramesTest, FramesThatTheMapHasNoTimeForAreTrackedOnly)
{
	options_.mappingQueue = 4;
	options_.segmentationQueue = 3;
	LiveFrames& live = start();
	const auto frames = std::size_t(recorded_.frames);
	// Nobody maps: tracking goes on to the end.
	while (timings_.summaries()["odometry"].count < frames) std::this_thread::sleep_for(1ms);
	const auto all = readAll(live);
	ASSERT_EQ(all.size(), frames);
	std::size_t segmented = 0;
	for (const auto& frame : all) segmented += bool(frame.frame.instances);
	EXPECT_EQ(segmented + live.unsegmented(), frames);
	// Full is the mapping queue with four, when three more may be on their way.
	EXPECT_GE(segmented, 3u);
	EXPECT_LE(segmented, 4u + 3u);
}

TEST_F(LiveFramesTest, WithoutHasteItIsTheRecordedRun)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 300;
	const RecordedRun recorded = recordRun(folder, options);
	const auto config = runConfiguration(recorded, 0.3);

	SemanticSlam expected(config, logger_, timings_);
	FrameSource source(
		std::make_unique<RawlogReader>(recorded.rawlog), makeFrontEnd(config), 0, timings_);
	while (const auto frame = source.next()) expected.process(*frame);
	expected.finish();

	SemanticSlam live(config, logger_, timings_);
	RawlogReader rawlog(recorded.rawlog);
	options_.segmentationQueue = options_.mappingQueue = 1000;
	{
		LiveFrames frames(rawlog, makeFrontEnd(config), live, options_, timings_);
		for (const auto& frame : readAll(frames)) live.integrate(frame.frame, frame.odometry);
	}
	live.finish();

	EXPECT_EQ(error_, "");
	ASSERT_EQ(live.frameCount(), std::size_t(recorded.frames));
	const auto a = live.trajectory(), b = expected.trajectory();
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		EXPECT_EQ(a[i].time, b[i].time);
		EXPECT_EQ(a[i].pose, b[i].pose) << i;
	}
	EXPECT_GT(live.map().objects().size(), 8u);
	EXPECT_EQ(associationsAsCsv(live.associations()), associationsAsCsv(expected.associations()));
}

TEST_F(LiveFramesTest, WhatEndsTheSensorComesBehindAllGoodFrames)
{
	sensor_->failAfter = 7;
	const auto all = readAll(start());
	EXPECT_EQ(all.size(), 7u);
	EXPECT_EQ(error_, "the cable is broken");
}

TEST_F(LiveFramesTest, WhatTheSegmenterThrowsEndsTheFramesBehindTheGoodOnes)
{
	const auto quick = segmenter_->script;
	segmenter_->script = [&](const RgbdFrame& frame)
	{
		if (frame.time == frameTime(5)) throw InputError("the network is of another camera");
		return quick(frame);
	};
	options_.segmentationQueue = options_.mappingQueue = 1000;
	sensor_->waitsAtEnd = true;
	const auto all = readAll(start());
	EXPECT_EQ(all.size(), 5u);
	EXPECT_EQ(error_, "the network is of another camera");
}

TEST_F(LiveFramesTest, CanBeLeftAtAnyTime)
{
	sensor_->waitsAtEnd = true;
	LiveFrames& live = start();
	while (!live.next(10ms))
	{
	}
	frames_.reset();
	EXPECT_LT(slam_->frameCount(), 1u);
}

TEST_F(LiveFramesTest, FramesThatCannotBeUsedAreSkippedAndTold)
{
	const std::string path = folder_.file("dark.rawlog");
	RawlogWriter writer(path);
	View view = renderView(roomScene(8), smallCamera(), cameraOnCircle(0));
	writer.write(scanOf(view, 0));
	writer.write(scanOf(view, 0));
	view.frame.depth.setTo(0);
	writer.write(scanOf(view, 1));
	writer.close();
	sensor_ = std::make_unique<ScriptedSensor>(path);
	LiveFrames& live = start();
	EXPECT_EQ(readAll(live).size(), 1u);
	EXPECT_EQ(error_, "");
	const auto skipped = live.takeSkipped();
	ASSERT_EQ(skipped.size(), 2u);
	EXPECT_THAT(skipped[0], HasSubstr("skipped: the frame before is of 1000.000000"));
	EXPECT_THAT(skipped[1], HasSubstr("no pixel has a valid depth"));
	EXPECT_EQ(live.takeSkipped().size(), 0u);
}
