#include <mrpt/obs/CObservation3DRangeScan.h>

#include "SemloopSlamFixture.h"
#include "TinyOnnx.h"

using namespace semloop;
using namespace semloop::synthetic;
using mrpt::obs::CObservation3DRangeScan;
using testing::AllOf;
using testing::HasSubstr;

namespace
{
/** What the program says of input that is at fault: one line, with the place and the remedy. */
class SemloopSlamBadInput : public SemloopSlamFixture
{
protected:
	SemloopSlamBadInput() : recorded_(recordShortRun()) {}

	/** Ends early, but what came before is on disk. */
	void expectResultsSoFar(int frames) const
	{
		EXPECT_EQ(messageLines(), 1u) << messages();
		EXPECT_THAT(messages(), HasSubstr("results so far are in " + folder_.file("result")));
		EXPECT_EQ(summary()["frames"], frames);
		EXPECT_EQ(
			readTumTrajectory(folder_.file("result/trajectory.tum")).size(), std::size_t(frames));
		EXPECT_THAT(messages(), HasSubstr(summary()["ended_by"].get<std::string>()));
	}
	/** With an ini file of these lines instead of the usual one. */
	std::string withConfig(const std::string& lines) const
	{
		return "-c '" + folder_.write("my.ini", lines) + "' -i '" + recorded_.rawlog + "' -o '" +
			   folder_.file("result") + "'";
	}

	/** A sidecar for the recording whose instances are of images half as wide. */
	std::string narrowInstances() const
	{
		const std::string path = folder_.file("narrow.rawlog");
		RawlogWriter writer(path);
		for (int i = 0; i < recorded_.frames; ++i) writer.write(narrow(i));
		writer.close();
		return path;
	}
	static CObservationInstances narrow(int index)
	{
		CObservationInstances instances;
		instances.timestamp = frameTime(index);
		instances.camera = smallCamera();
		instances.camera.ncols /= 2;
		instances.labels = roomLabels();
		return instances;
	}

	const RecordedRun recorded_;
};
}  // namespace

TEST_F(SemloopSlamBadInput, AnUnknownKeyInTheConfigurationIsNamedWithTheKnownOnes)
{
	EXPECT_EQ(
		run(withConfig("[odometry]\ndrfit = 1\n[segmentation]\nfile = " + recorded_.rawlog)), 2);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), AllOf(HasSubstr("my.ini: [odometry] drfit"), HasSubstr("unknown key")));
}

TEST_F(SemloopSlamBadInput, AKeyAboveTheFirstSectionIsNamed)
{
	EXPECT_EQ(run(withConfig("drift = 1\n")), 2);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), HasSubstr("my.ini: drift: stands above the first section"));
}

TEST_F(SemloopSlamBadInput, AnUnregisteredModuleIsNamedWithTheRegisteredOnes)
{
	EXPECT_EQ(
		run(withConfig(
			"[modules]\nodometry = semloop::Teleporter\n[segmentation]\nfile = " +
			recorded_.rawlog)),
		2);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(
		messages(), AllOf(
						HasSubstr("my.ini: [modules] odometry"), HasSubstr("semloop::Teleporter"),
						HasSubstr("semloop::RecordedOdometry")));
}

TEST_F(SemloopSlamBadInput, ANetworkOfAnotherLayoutIsNamedBeforeTheWorkBegins)
{
	const std::string network = folder_.write("embedding.onnx", test::tinyEmbedding());
	EXPECT_EQ(
		run(withConfig(
			"[modules]\nsegmenter = semloop::DnnSegmenter\n[segmentation]\nmodel = " + network)),
		1);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(
		messages(), AllOf(
						HasSubstr(network + ": not a segmentation network"),
						HasSubstr("doc/segmentation-networks.md")));
}

TEST_F(SemloopSlamBadInput, AConfigurationThatLacksTheNetworkIsNamedWithTheKey)
{
	EXPECT_EQ(run(withConfig("[modules]\nsegmenter = semloop::DnnSegmenter\n")), 2);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), HasSubstr("my.ini: [segmentation] model: missing"));
}

TEST_F(SemloopSlamBadInput, ANetworkOfAnotherImageSizeIsNamedWithBothSizes)
{
	const std::string network = folder_.write("yolo.onnx", test::tinyYoloSeg());
	EXPECT_EQ(
		run(withConfig(
			"[modules]\nsegmenter = semloop::DnnSegmenter\n[segmentation]\nmodel = " + network +
			"\ninput_width = 640\ninput_height = 480\n")),
		1);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), AllOf(HasSubstr(network), HasSubstr("64x32"), HasSubstr("640x480")));
}

TEST_F(SemloopSlamBadInput, ARecordingThatWasNotSegmentedSaysHowToDoIt)
{
	EXPECT_EQ(run(withConfig("")), 1);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), AllOf(HasSubstr("room_instances.rawlog"), HasSubstr("rawlog-segment")));
}

TEST_F(SemloopSlamBadInput, InstancesOfAnotherImageSizeEndTheRunWithBothSizes)
{
	const RecordedRun scans = changed(recorded_, [](int, CObservation3DRangeScan&) {});
	EXPECT_EQ(run(arguments(scans, narrowInstances())), 1);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(
		messages(), AllOf(
						HasSubstr("narrow.rawlog: instances at 1000.0"), HasSubstr("160x120"),
						HasSubstr("rawlog-segment")));
}

TEST_F(SemloopSlamBadInput, InstancesInTheRawlogOfAnotherImageSizeEndTheRunToo)
{
	RecordedRun merged = recorded_;
	merged.rawlog = folder_.file("merged.rawlog");
	RawlogReader reader(recorded_.rawlog);
	RawlogWriter writer(merged.rawlog);
	for (int index = 0; const auto observation = reader.next();)
	{
		if (!std::dynamic_pointer_cast<CObservation3DRangeScan>(observation)) continue;
		writer.write(*observation);
		if (index++ == 3) writer.write(narrow(3));
	}
	writer.close();
	EXPECT_EQ(run(arguments(merged)), 1);
	expectResultsSoFar(3);
	EXPECT_THAT(messages(), AllOf(HasSubstr("merged.rawlog"), HasSubstr("rawlog-segment")));
}

TEST_F(SemloopSlamBadInput, OfFramesBehindTheOneThatEndsTheRunNothingIsTold)
{
	RecordedRun merged = recorded_;
	merged.rawlog = folder_.file("merged.rawlog");
	RawlogReader reader(recorded_.rawlog);
	RawlogWriter writer(merged.rawlog);
	for (int index = 0; const auto observation = reader.next();)
	{
		const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation);
		if (!scan) continue;
		// They are read ahead while the one before is mapped.
		if (index > 3) scan->hasRangeImage = false;
		writer.write(*scan);
		CObservationInstances instances;
		instances.timestamp = frameTime(index);
		instances.camera = smallCamera();
		instances.labels = index < 3 ? roomLabels() : LabelSet({"door", "window"});
		writer.write(instances);
		++index;
	}
	writer.close();
	EXPECT_EQ(run(arguments(merged)), 1);
	expectResultsSoFar(4);
	EXPECT_THAT(messages(), HasSubstr("their label set is not that of the instances before"));
	EXPECT_EQ(summary()["frames_skipped"], 0);
}

TEST_F(SemloopSlamBadInput, InstancesOfAnotherRecordingAreWarnedAbout)
{
	const RecordedRun scans = changed(recorded_, [](int, CObservation3DRangeScan&) {});
	ASSERT_EQ(run(arguments(scans, scans.rawlog)), 0) << messages();
	EXPECT_EQ(summary()["frames_segmented"], 0);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), HasSubstr("warning: no frame has instances"));
}

TEST_F(SemloopSlamBadInput, ARawlogThatIsNoneIsToldSo)
{
	RecordedRun other = recorded_;
	other.rawlog = folder_.write("other.rawlog", "Dear diary, today we went mapping.");
	EXPECT_EQ(run(arguments(other, recorded_.rawlog)), 1);
	EXPECT_THAT(messages(), AllOf(HasSubstr("other.rawlog"), HasSubstr("not a rawlog")));
	EXPECT_EQ(messageLines(), 1u) << messages();
}

TEST_F(SemloopSlamBadInput, ACutSidecarKeepsTheResultsSoFarAndFails)
{
	const std::string bytes = readBytes(recorded_.rawlog);
	const std::string cut = folder_.write("cut.rawlog", bytes.substr(0, bytes.size() / 2));
	const RecordedRun scans = changed(recorded_, [](int, CObservation3DRangeScan&) {});
	EXPECT_EQ(run(arguments(scans, cut)), 1);
	EXPECT_GT(summary()["frames"], 0);
	expectResultsSoFar(summary()["frames"]);
	EXPECT_THAT(messages(), HasSubstr(cut));
}

TEST_F(SemloopSlamBadInput, AFrameWithoutValidDepthIsSkippedAndCounted)
{
	const RecordedRun holed = changed(
		recorded_,
		[](int index, CObservation3DRangeScan& scan)
		{
			if (index == 4) scan.rangeImage.fill(0);
		});
	ASSERT_EQ(run(arguments(holed, recorded_.rawlog)), 0) << messages();
	EXPECT_EQ(summary()["frames"], recorded_.frames - 1);
	EXPECT_EQ(summary()["frames_skipped"], 1);
	EXPECT_EQ(messageLines(), 1u) << messages();
	EXPECT_THAT(messages(), AllOf(HasSubstr("warning"), HasSubstr("no pixel has a valid depth")));
}

TEST_F(SemloopSlamBadInput, ARecordingWithoutAnyValidDepthFailsAndSaysSo)
{
	const RecordedRun blind =
		changed(recorded_, [](int, CObservation3DRangeScan& scan) { scan.rangeImage.fill(0); });
	EXPECT_EQ(run(arguments(blind, recorded_.rawlog)), 1);
	EXPECT_EQ(summary()["frames_skipped"], recorded_.frames);
	EXPECT_THAT(messages(), HasSubstr("no usable RGB-D frame"));
}

TEST_F(SemloopSlamBadInput, TimeGoingBackwardsKeepsTheResultsSoFarAndFails)
{
	const RecordedRun unsorted = changed(
		recorded_,
		[](int index, CObservation3DRangeScan& scan)
		{
			if (index == 5) scan.timestamp = frameTime(2);
		});
	EXPECT_EQ(run(arguments(unsorted, recorded_.rawlog)), 1);
	expectResultsSoFar(5);
	EXPECT_THAT(
		messages(), AllOf(
						HasSubstr("changed.rawlog: frame at 1000.2"),
						HasSubstr("time goes backwards"), HasSubstr("sort the rawlog")));
}

TEST_F(SemloopSlamBadInput, ADamagedFrameInTheMiddleIsSkippedWithAWarningAndCounted)
{
	const std::string image = folder_.write("damaged.png", "\x89PNG, and then something else");
	const RecordedRun damaged = changed(
		recorded_,
		[&](int index, CObservation3DRangeScan& scan)
		{
			if (index == 4) scan.intensityImage.setExternalStorage(image);
			if (index == 6) scan.hasRangeImage = false;
		});
	ASSERT_EQ(run(arguments(damaged, recorded_.rawlog)), 0) << messages();
	EXPECT_EQ(summary()["frames"], recorded_.frames - 2);
	EXPECT_EQ(summary()["frames_skipped"], 2);
	EXPECT_EQ(summary()["ended_by"], "end of the rawlog");
	EXPECT_THAT(summary()["skipped"][0].get<std::string>(), HasSubstr(image));
	EXPECT_EQ(messageLines(), 2u) << messages();
	EXPECT_THAT(
		messages(), AllOf(HasSubstr("semloop-slam: warning: "), HasSubstr("no depth image")));
}

TEST_F(SemloopSlamBadInput, AFrameSkippedRightBeforeTheRunEndsIsCountedToo)
{
	const RecordedRun damaged = changed(
		recorded_,
		[](int index, CObservation3DRangeScan& scan)
		{
			if (index == 4) scan.hasRangeImage = false;
			if (index == 5) scan.timestamp = frameTime(2);
		});
	EXPECT_EQ(run(arguments(damaged, recorded_.rawlog)), 1);
	EXPECT_EQ(summary()["frames"], 4);
	EXPECT_EQ(summary()["frames_skipped"], 1);
	EXPECT_THAT(messages(), AllOf(HasSubstr("no depth image"), HasSubstr("time goes backwards")));
}
