#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/stock_objects.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>
#include <semloop/pose_graph/G2oFile.h>
#include <semloop/slam/PathLine.h>
#include <semloop/slam/RunResults.h>
#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "SimpleMapFile.h"

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
void writeText(const fs::path& path, const std::string& text)
{
	std::ofstream out(path, std::ios::binary);
	out << text;
	if (!out.flush()) throw InputError(path.string() + ": cannot be written; is the disk full?");
}

void requireWritten(bool ok, const fs::path& path)
{
	if (!ok) throw InputError(path.string() + ": cannot be written; is the disk full?");
}

void writeMeshes(const fs::path& folder, const SemanticSlam& slam)
{
	fs::remove_all(folder);
	fs::create_directories(folder);
	for (const auto& [id, object] : slam.map().objects())
	{
		if (object.observations < slam.options().minObservations) continue;
		savePly(
			(folder / objectFileName(id, slam.map().labelName(object))).string(),
			object.volume->mesh(), object.T_world_object);
	}
}

void writeScene(const fs::path& path, const SemanticSlam& slam)
{
	mrpt::opengl::COpenGLScene scene;
	auto objects = mrpt::opengl::CSetOfObjects::Create();
	objects->setName("objects");
	slam.map().getVisualizationInto(*objects);
	scene.insert(objects);
	auto estimated = pathLine(slam.trajectory(), kTrajectoryColor);
	estimated->setName("trajectory");
	scene.insert(estimated);
	auto odometry = pathLine(slam.odometryTrajectory(), kOdometryColor);
	odometry->setName("odometry");
	scene.insert(odometry);
	scene.insert(mrpt::opengl::stock_objects::CornerXYZ(0.3f));
	requireWritten(scene.saveToFile(path.string()), path);
}

double peakMemoryMegabytes()
{
	rusage usage{};
	getrusage(RUSAGE_SELF, &usage);
	return double(usage.ru_maxrss) / 1024.0;
}

double pathLength(const Trajectory& trajectory)
{
	double length = 0;
	for (std::size_t i = 1; i < trajectory.size(); ++i)
		length += trajectory[i].pose.distanceTo(trajectory[i - 1].pose);
	return length;
}

std::string summary(const SemanticSlam& slam, const RunInfo& info, const StageTimings& timings)
{
	nlohmann::ordered_json labels = nlohmann::ordered_json::object();
	std::map<std::string, int> objectsOfLabel;
	for (const auto& entry : slam.map().objects())
		if (entry.second.observations >= slam.options().minObservations)
			++objectsOfLabel[slam.map().labelName(entry.second)];
	for (const auto& [label, count] : objectsOfLabel) labels[label] = count;

	const auto stages = timings.summaries();
	const auto meanOf = [&](const char* stage)
	{
		const auto it = stages.find(stage);
		return it == stages.end()
				   ? 0.0
				   : it->second.milliseconds / double(std::max<std::size_t>(1, slam.frameCount()));
	};

	nlohmann::ordered_json json;
	json["format"] = "semloop.summary/1";
	json["rawlog"] = info.rawlog;
	json["config"] = info.config;
	json["ended_by"] = info.endedBy;
	json["frames"] = slam.frameCount();
	json["frames_segmented"] = slam.segmentedFrameCount();
	json["frames_skipped"] = info.skippedFrames;
	json["frames_lost"] = slam.lostFrameCount();
	json["skipped"] = info.warnings;
	if (info.live)
		json["live"] = {
			{"observations_grabbed", info.live->sensor.grabbed},
			{"observations_dropped", info.live->sensor.dropped},
			{"frames_unsegmented", info.live->unsegmented},
			{"observations_recorded", info.live->recorder.recorded},
			{"observations_not_recorded", info.live->recorder.omitted},
			{"stalls", info.live->sensor.stalls},
			{"longest_stall_s", info.live->sensor.longestStall}};
	json["path_length_m"] = pathLength(slam.trajectory());
	json["detections"] = slam.detectionCount();
	json["objects"] = slam.map().objects().size();
	json["objects_by_label"] = labels;
	json["loops_tried"] = slam.loops().size();
	json["loops_accepted"] = countLoops(slam.loops(), LoopVerdict::Decision::Accepted);
	json["loops_ambiguous"] = countLoops(slam.loops(), LoopVerdict::Decision::Ambiguous);
	json["graph_nodes"] = slam.poseGraph().nodes().size();
	json["graph_edges"] = slam.poseGraph().edges().size();
	json["wall_seconds"] = info.wallSeconds;
	json["frames_per_second"] =
		info.wallSeconds > 0 ? double(slam.frameCount()) / info.wallSeconds : 0.0;
	json["odometry_ms_per_frame"] = meanOf("odometry");
	json["mapping_ms_per_frame"] = meanOf("mapping");
	json["front_end_ms_per_frame"] = meanOf("read") + meanOf("segmentation") + meanOf("rectify");
	json["peak_memory_mb"] = peakMemoryMegabytes();
	return json.dump(2) + "\n";
}

/** All of them, also behind one that fails; throws the first failure at the end. */
void writeEach(const std::vector<std::function<void()>>& files)
{
	std::exception_ptr failure;
	for (const auto& write : files) try
		{
			write();
		}
		catch (...)
		{
			if (!failure) failure = std::current_exception();
		}
	if (failure) std::rethrow_exception(failure);
}
}  // namespace

void writeRunResults(
	const std::string& folder, const SemanticSlam& slam, const RunInfo& info,
	const StageTimings& timings)
{
	const fs::path out(folder);
	const auto graph = [&]
	{
		SemanticGraph::fromMap(slam.map(), slam.options().minObservations)
			.save((out / "objects.json").string());
	};
	writeEach(
		{[&] { writeTumTrajectory((out / "trajectory.tum").string(), slam.trajectory()); },
		 [&] {
			 writeTumTrajectory(
				 (out / "trajectory_odometry.tum").string(), slam.odometryTrajectory());
		 },
		 graph, [&] { saveObjectMap((out / "map.objmap").string(), slam.map()); },
		 [&] { writeMeshes(out / "objects", slam); },
		 [&] { saveSimpleMap((out / "map.simplemap").string(), slam); },
		 [&] { writeScene(out / "scene.3Dscene", slam); },
		 [&] { writeG2o((out / "pose_graph.g2o").string(), slam.poseGraph()); },
		 [&] { writeText(out / "loops.jsonl", loopsAsJsonLines(slam.loops())); },
		 [&] { writeText(out / "associations.csv", associationsAsCsv(slam.associations())); },
		 [&] { timings.writeCsv((out / "timings.csv").string()); },
		 [&] { writeText(out / "summary.json", summary(slam, info, timings)); }});
}

}  // namespace semloop
