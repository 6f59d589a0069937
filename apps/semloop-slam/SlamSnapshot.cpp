#include "SlamSnapshot.h"

#include <algorithm>

namespace semloop
{
namespace
{
constexpr std::chrono::milliseconds kBetweenMaps(300);
constexpr std::chrono::seconds kBetweenRates(1);
constexpr int kInverseShareOfMaps = 20;  // of the run's time

void takeLoops(const std::vector<LoopRecord>& loops, MapSnapshot& snapshot)
{
	using Decision = LoopVerdict::Decision;
	snapshot.loopsAccepted = countLoops(loops, Decision::Accepted);
	snapshot.loopsAmbiguous = countLoops(loops, Decision::Ambiguous);
	snapshot.loopsRejected = countLoops(loops, Decision::Rejected);
	const auto last = std::find_if(
		loops.rbegin(), loops.rend(),
		[](const LoopRecord& loop) { return loop.verdict.decision == Decision::Accepted; });
	if (last == loops.rend()) return;
	snapshot.lastLoopFrame = last->frame;
	snapshot.lastLoop = last->matched;
}
}  // namespace

SlamSnapshot SnapshotTaker::take(
	const SlamFrame* frame, const SemanticSlam& slam, const StageTimings& timings,
	const WindowNews& news, bool withMap)
{
	// A frame that was tracked only has no image any more.
	if (frame && !frame->rgbd.color.empty())
		picture_ = {frame->rgbd.color, frame->instances, frame->rgbd.camera, frame->progress};
	SlamSnapshot snapshot;
	snapshot.picture = picture_;
	snapshot.frames = slam.frameCount();
	if (snapshot.frames > 0)
		snapshot.T_world_camera = slam.poseGraph().pose(NodeId::camera(snapshot.frames - 1));
	snapshot.notSegmented = snapshot.frames - slam.segmentedFrameCount();
	snapshot.lost = slam.lostFrameCount();
	snapshot.news = news;

	const auto start = Clock::now();
	if (!withMap && start < mapDue_) return snapshot;
	snapshot.map = takeMap(slam, timings);
	mapDue_ = start +
			  std::max<Clock::duration>(kBetweenMaps, kInverseShareOfMaps * (Clock::now() - start));
	return snapshot;
}

MapSnapshot SnapshotTaker::takeMap(const SemanticSlam& slam, const StageTimings& timings)
{
	MapSnapshot snapshot;
	snapshot.map = slam.map();
	snapshot.trajectory = slam.trajectory();
	snapshot.odometryTrajectory = slam.odometryTrajectory();
	takeLoops(slam.loops(), snapshot);
	updateRates(slam, timings);
	snapshot.framesPerSecond = framesPerSecond_;
	snapshot.stages = stages_;
	return snapshot;
}

void SnapshotTaker::updateRates(const SemanticSlam& slam, const StageTimings& timings)
{
	const auto now = Clock::now();
	const double seconds = std::chrono::duration<double>(now - ratesSince_).count();
	if (now - ratesSince_ < kBetweenRates) return;
	auto totals = timings.totals();
	for (const auto& [stage, total] : totals)
	{
		const StageTimings::Total& then = totalsThen_[stage];
		const double calls = double(total.count - then.count);
		StageRate& rate = stages_[stage];
		rate.perSecond = calls / seconds;
		if (calls > 0) rate.milliseconds = (total.milliseconds - then.milliseconds) / calls;
	}
	framesPerSecond_ = double(slam.frameCount() - framesThen_) / seconds;
	ratesSince_ = now;
	framesThen_ = slam.frameCount();
	totalsThen_ = std::move(totals);
}

}  // namespace semloop
