#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/AssociationAccuracy.h>
#include <semloop/evaluation/LoopEvaluation.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/FrameSource.h>
#include <semloop/slam/RunResults.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "SyntheticRun.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
struct Run
{
	mrpt::system::COutputLogger logger;
	StageTimings timings;
	std::unique_ptr<SemanticSlam> slam;
};

/** change: what to do to each frame before. */
std::unique_ptr<Run> mapRawlog(
	const std::string& rawlog, const mrpt::config::CConfigFileBase& config, int framesAhead,
	const std::function<void(const SlamFrame&)>& change = [](const SlamFrame&) {})
{
	auto run = std::make_unique<Run>();
	run->logger.logging_enable_console_output = false;
	run->slam = std::make_unique<SemanticSlam>(config, run->logger, run->timings);
	FrontEnd front = makeFrontEnd(config);
	FrameSource source(std::make_unique<RawlogReader>(rawlog), front, framesAhead, run->timings);
	while (auto frame = source.next())
	{
		change(*frame);
		run->slam->process(*frame);
	}
	run->slam->finish();
	return run;
}

double absoluteError(const Trajectory& estimate, const std::string& truth)
{
	return absoluteTrajectoryError(associateByTime(estimate, readTumTrajectory(truth)))
		.translation.rmse;
}

/** What must not depend on time or machine. */
std::string fingerprint(const SemanticSlam& slam, const TemporaryFolder& folder)
{
	writeTumTrajectory(folder.file("t.tum"), slam.trajectory());
	SemanticGraph::fromMap(slam.map()).save(folder.file("g.json"));
	return readBytes(folder.file("t.tum")) + readBytes(folder.file("g.json")) +
		   loopsAsJsonLines(slam.loops()) + associationsAsCsv(slam.associations());
}
}  // namespace

TEST(SemanticSlam, MapsEveryObjectOfARoomOnceWithoutDrift)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 300;
	const RecordedRun recorded = recordRun(folder, options);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0), 2);
	EXPECT_EQ(run->slam->frameCount(), std::size_t(recorded.frames));
	EXPECT_LT(absoluteError(run->slam->trajectory(), recorded.truth), 1e-3);

	// Object and truth meet where the world begins: at the first camera, levelled.
	const CPose3D T_truth_world = cameraOnCircle(0) + (-run->slam->trajectory().front().pose);
	const Scene scene = roomScene(options.objects);
	std::map<int, int> found;
	for (const auto& [id, object] : run->slam->map().objects())
	{
		const auto centre = T_truth_world.composePoint(object.centre());
		int nearest = 0;
		double distance = 1e9;
		const auto look = [&](const TPoint3D& at, int objectId)
		{
			if ((at - centre).norm() < distance)
				distance = (at - centre).norm(), nearest = objectId;
		};
		for (const auto& s : scene.spheres) look(s.centre, s.id);
		for (const auto& b : scene.boxes) look(b.T_world_box.translation(), b.id);
		// One side only is ever seen, so the centre is off by up to half the size.
		EXPECT_LT(distance, 0.2) << "object " << id;
		EXPECT_EQ(object.label(), labelOf(nearest));
		++found[nearest];
	}
	EXPECT_GE(found.size(), 12u);
	for (const auto& [id, count] : found) EXPECT_EQ(count, 1) << "object " << id;
}

TEST(SemanticSlam, ALoopClosureTakesOutMostOfTheDrift)
{
	const TemporaryFolder folder;
	const RecordedRun recorded = recordRun(folder);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0.8), 2);
	std::size_t accepted = 0;
	for (const auto& record : run->slam->loops())
		accepted += record.verdict.decision == LoopVerdict::Decision::Accepted;
	EXPECT_GE(accepted, 1u);
	const double before = absoluteError(run->slam->odometryTrajectory(), recorded.truth);
	const double after = absoluteError(run->slam->trajectory(), recorded.truth);
	EXPECT_GT(before, 0.1);
	EXPECT_LT(after, 0.5 * before);
}

TEST(SemanticSlam, BehindALoopClosureTheCameraGoesOnFromItsCorrectedPose)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.objects = 60;
	const RecordedRun recorded = recordRun(folder, options);
	auto config = runConfiguration(recorded, 0.8);
	config.write("odometry", "noise", 0.1);
	mrpt::system::COutputLogger logger;
	logger.logging_enable_console_output = false;
	StageTimings timings;
	SemanticSlam slam(config, logger, timings);
	FrontEnd front = makeFrontEnd(config);
	FrameSource source(std::make_unique<RawlogReader>(recorded.rawlog), front, 2, timings);
	const auto isClosed = [&]
	{
		return !slam.loops().empty() &&
			   slam.loops().back().verdict.decision == LoopVerdict::Decision::Accepted;
	};
	auto frame = source.next();
	for (; frame && !isClosed(); frame = source.next()) slam.process(*frame);
	ASSERT_TRUE(frame.has_value());
	frame->instances.reset();  // the objects would correct the pose anew
	slam.process(*frame);
	const auto stepOf = [](const Trajectory& t)
	{ return (t.end() - 1)->pose - (t.end() - 2)->pose; };
	const CPose3D step = stepOf(slam.trajectory()), odometry = stepOf(slam.odometryTrajectory());
	EXPECT_LT((step - odometry).norm(), 1e-9);
	EXPECT_GT((slam.trajectory().back().pose - slam.odometryTrajectory().back().pose).norm(), 0.3);
}

TEST(SemanticSlam, AssociationsFollowTheMergesOfALoopClosure)
{
	const TemporaryFolder folder;
	const RecordedRun recorded = recordRun(folder);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0.8), 2);
	const auto associations = run->slam->associations();
	std::map<ObjectId, std::set<ObjectId>> origins;
	std::size_t previous = 0;
	for (const auto& a : associations)
	{
		EXPECT_GE(a.frame, previous);
		previous = a.frame;
		EXPECT_EQ(a.time, frameTime(int(a.frame)));
		EXPECT_GT(a.box.area(), 0);
		origins[a.object].insert(a.firstObject);
	}
	const auto& objects = run->slam->map().objects();
	for (const auto& entry : objects) EXPECT_EQ(origins.count(entry.first), 1u) << entry.first;
	for (const auto& [id, firsts] : origins)
		for (const auto first : firsts)
			EXPECT_TRUE(first == id || objects.count(first) == 0) << "absorbed, but still there";
	const auto merged = [](const auto& entry) { return entry.second.size() > 1; };
	EXPECT_GE(std::count_if(origins.begin(), origins.end(), merged), 3);
}

TEST(SemanticSlam, WhatATrackSawBeforeItCountedIsItsObjectToo)
{
	const TemporaryFolder folder;
	const RecordedRun recorded = recordRun(folder);
	// Nothing goes into the map before a track's third frame.
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0), 2);
	const auto associations = run->slam->associations();
	ASSERT_FALSE(associations.empty());
	EXPECT_EQ(associations.front().frame, 0u);
	std::set<std::pair<std::size_t, std::size_t>> detections;
	for (const auto& a : associations)
		EXPECT_TRUE(detections.insert({a.frame, a.instance}).second) << "told twice";
}

TEST(SemanticSlam, WhatAllObjectsSayOutvotesNoisyPoses)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 240;
	options.objects = 60;
	const RecordedRun recorded = recordRun(folder, options);
	const auto accuracyWith = [&](bool registration)
	{
		auto config = runConfiguration(recorded, 0);
		config.write("odometry", "noise", 0.15);
		config.write("frame_registration", "enabled", registration);
		config.write("local_map", "length", 1000);
		config.write("slam", "loop_every_frames", 1000);
		const auto run = mapRawlog(recorded.rawlog, config, 2);
		const double noisy = absoluteError(run->slam->odometryTrajectory(), recorded.truth);
		const double estimated = absoluteError(run->slam->trajectory(), recorded.truth);
		EXPECT_GT(noisy, 0.2);
		if (registration)
		{
			EXPECT_LT(estimated, 0.5 * noisy);
		}
		return *associationAccuracy(joinWithTruth(
										run->slam->trajectory(), run->slam->associations(),
										readTrueFrames(recorded.rawlog)))
					.accuracy;
	};
	const double with = accuracyWith(true), without = accuracyWith(false);
	EXPECT_GT(with, 0.95);
	EXPECT_LT(without, with - 0.1);
}

TEST(SemanticSlam, WhatItWritesIsWhatTheEvaluationReads)
{
	const TemporaryFolder folder;
	const RecordedRun recorded = recordRun(folder);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0.8), 2);
	writeRunResults(folder.path().string(), *run->slam, RunInfo(), run->timings);

	const auto frames = joinWithTruth(
		readTumTrajectory(folder.file("trajectory.tum")),
		readAssociations(folder.file("associations.csv")), readTrueFrames(recorded.rawlog));
	EXPECT_EQ(frames.size(), std::size_t(recorded.frames));
	const auto accuracy = associationAccuracy(frames);
	EXPECT_EQ(accuracy.detectedBoxes, run->slam->associations().size());
	EXPECT_GT(*accuracy.accuracyOfDetected, 0.9);

	const auto attempts = readLoopAttempts(folder.file("loops.jsonl"));
	ASSERT_EQ(attempts.size(), run->slam->loops().size());
	LoopRule rule;
	rule.framesApart = 50;   // of 72 in a round
	rule.commonObjects = 1;  // few frames see three
	const auto loops = evaluateLoops(attempts, frames, rule);
	EXPECT_GE(loops.verified.truePositives, 1u);
	EXPECT_EQ(loops.verified.falsePositives, 0u);
	EXPECT_GE(loops.detected.detections, loops.verified.detections);
	EXPECT_GT(*loops.recall, 0);
}

TEST(SemanticSlam, NoLoopIsClosedWhereNoneIs)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 280;
	const RecordedRun recorded = recordRun(folder, options);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0.3), 2);
	for (const auto& record : run->slam->loops())
		EXPECT_NE(record.verdict.decision, LoopVerdict::Decision::Accepted)
			<< record.verdict.reason;
	EXPECT_GT(run->slam->loops().size(), 0u);
}

TEST(SemanticSlam, TheSameInputGivesTheSameBytesWithAndWithoutAThread)
{
	const TemporaryFolder folder;
	const RecordedRun recorded = recordRun(folder);
	const auto config = runConfiguration(recorded, 0.8);
	const auto first = mapRawlog(recorded.rawlog, config, 0);
	const auto second = mapRawlog(recorded.rawlog, config, 0);
	const auto threaded = mapRawlog(recorded.rawlog, config, 4);
	const std::string expected = fingerprint(*first->slam, folder);
	EXPECT_GT(expected.size(), 1000u);
	EXPECT_EQ(fingerprint(*second->slam, folder), expected);
	EXPECT_EQ(fingerprint(*threaded->slam, folder), expected);
}

TEST(SemanticSlam, EveryFileOfARunIsWritten)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 60;
	const RecordedRun recorded = recordRun(folder, options);
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0), 0);
	writeRunResults(folder.path().string(), *run->slam, RunInfo(), run->timings);
	for (const char* name :
		 {"trajectory.tum", "trajectory_odometry.tum", "objects.json", "map.objmap",
		  "map.simplemap", "scene.3Dscene", "pose_graph.g2o", "loops.jsonl", "associations.csv",
		  "timings.csv", "summary.json"})
		EXPECT_FALSE(readBytes(folder.file(name)).empty()) << name;
	EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "objects"));
	const auto summary = nlohmann::json::parse(readBytes(folder.file("summary.json")));
	EXPECT_EQ(summary["frames"], recorded.frames);
	EXPECT_EQ(summary["frames_skipped"], 0);
	EXPECT_EQ(
		readTumTrajectory(folder.file("trajectory.tum")).size(), std::size_t(recorded.frames));
}

TEST(SemanticSlam, AnImageThatIsGoneCostsTheSimpleMapAndNothingElse)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 30;
	const RecordedRun recorded = recordRun(folder, options);
	const std::string name = folder.file("colour.png");
	const auto run = mapRawlog(
		recorded.rawlog, runConfiguration(recorded, 0), 0,
		[&](const SlamFrame& frame)
		{
			if (std::filesystem::exists(name)) return;
			ASSERT_TRUE(frame.scan->intensityImage.saveToFile(name));
			frame.scan->intensityImage.setExternalStorage(name);
		});
	std::filesystem::remove(name);
	const auto message = messageOf<InputError>(
		[&] { writeRunResults(folder.path().string(), *run->slam, RunInfo(), run->timings); });
	EXPECT_NE(message.find("colour.png"), std::string::npos) << message;
	EXPECT_FALSE(std::filesystem::exists(folder.file("map.simplemap")));
	for (const char* file : {"map.objmap", "scene.3Dscene", "loops.jsonl", "summary.json"})
		EXPECT_FALSE(readBytes(folder.file(file)).empty()) << file;
}

TEST(SemanticSlam, ARunWithoutAFrameWritesEmptyResults)
{
	const TemporaryFolder folder;
	RawlogWriter(folder.file("empty.rawlog")).close();
	RecordedRun recorded;
	recorded.rawlog = folder.file("empty.rawlog");
	recorded.truth = folder.write("truth.tum", "1000 0 0 0 0 0 0 1\n");
	const auto run = mapRawlog(recorded.rawlog, runConfiguration(recorded, 0), 0);
	writeRunResults(folder.path().string(), *run->slam, RunInfo(), run->timings);
	EXPECT_EQ(run->slam->frameCount(), 0u);
	EXPECT_TRUE(run->slam->map().isEmpty());
}

TEST(SemanticSlam, AnUnregisteredModuleAndAnUnknownSectionStopWithTheChoices)
{
	const TemporaryFolder folder;
	StageTimings timings;
	mrpt::system::COutputLogger logger;
	mrpt::config::CConfigFileMemory config;
	config.write("modules", "odometry", "semloop::Teleporter");
	const auto module = messageOf<UsageError>([&] { SemanticSlam slam(config, logger, timings); });
	EXPECT_NE(module.find("semloop::RecordedOdometry"), std::string::npos) << module;

	mrpt::config::CConfigFileMemory typo;
	typo.write("tracing", "gate", 0.5);
	const auto section = messageOf<UsageError>([&] { SemanticSlam slam(typo, logger, timings); });
	EXPECT_NE(section.find("[tracing]"), std::string::npos) << section;
}

TEST(SemanticSlam, KeyPosesAreFewHoweverLongTheWay)
{
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 300;
	const RecordedRun recorded = recordRun(folder, options);
	auto config = runConfiguration(recorded, 0);
	const auto all = mapRawlog(recorded.rawlog, config, 0);
	config.write("slam", "max_key_poses", 8);
	const auto few = mapRawlog(recorded.rawlog, config, 0);
	const auto &every = all->slam->keyFrames(), &some = few->slam->keyFrames();
	// More than twice as many as may be, less than four times: the distance is doubled twice.
	ASSERT_GT(every.size(), 16u);
	ASSERT_LT(every.size(), 32u);
	EXPECT_GE(some.size(), 4u);
	EXPECT_LE(some.size(), 8u);
	// From the beginning to near the end.
	EXPECT_EQ(some.front().frame, every.front().frame);
	const std::size_t step = 4 * (every[1].frame - every[0].frame);
	for (std::size_t i = 1; i < some.size(); ++i)
	{
		// Each of the four steps was rounded up to whole frames, by less than one; a long step is that once.
		EXPECT_LE(some[i].frame - some[i - 1].frame, step) << i;
		EXPECT_GT(some[i].frame - some[i - 1].frame + 4, step) << i;
	}
	EXPECT_GT(some.back().frame + step, every.back().frame);
	EXPECT_TRUE(some.back().scan && some.back().instances);
}
