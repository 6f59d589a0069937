#include <semloop/observations/UnixTime.h>
#include <semloop/slam/RunResults.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

namespace semloop
{
namespace
{
nlohmann::ordered_json orNull(const std::optional<double>& value)
{
	if (value) return *value;
	return nullptr;
}

nlohmann::ordered_json toJson(const LoopRecord& record)
{
	const LoopVerdict& v = record.verdict;
	nlohmann::ordered_json line;
	line["frame"] = record.frame;
	line["time"] = mrpt::Clock::toDouble(record.time);
	line["local_map_since"] = record.localMapSince;
	line["decision"] = toString(v.decision);
	line["reason"] = v.reason;
	line["probability"] = v.probability;
	line["matches"] = v.matches;
	auto& matched = line["matched_objects"] = nlohmann::ordered_json::array();
	for (const MatchedObjects& m : record.matched)
		matched.push_back(
			{{"query_label", m.queryLabel},
			 {"target_label", m.targetLabel},
			 {"query_centre", {m.queryCentre.x, m.queryCentre.y, m.queryCentre.z}},
			 {"target_centre", {m.targetCentre.x, m.targetCentre.y, m.targetCentre.z}}});
	auto& cameras = line["cameras"] = nlohmann::ordered_json::array();
	for (const CameraMatch& m : v.cameras) cameras.push_back({m.query, m.target, m.inliers});
	if (v.decision == LoopVerdict::Decision::Accepted || v.hasPose)
	{
		const auto T = v.T_target_query.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>();
		auto& rows = line["T_target_query"] = nlohmann::ordered_json::array();
		for (int r = 0; r < 4; ++r)
			for (int c = 0; c < 4; ++c) rows.push_back(T(r, c));
	}
	else
		line["T_target_query"] = nullptr;
	if (record.prior)
		line["prior"] = {
			{"sigma_xy", record.prior->sigmaXY},
			{"sigma_z", record.prior->sigmaZ},
			{"sigma_yaw", record.prior->sigmaYaw}};
	else
		line["prior"] = nullptr;
	line["query_objects"] = v.queryObjects;
	line["candidates"] = v.candidates;
	line["graphs_match"] = v.graphsMatch;
	line["matched_edge_share"] = orNull(v.matchedEdgeShare);
	line["matching_score"] = orNull(v.matchingScore);
	line["evidence"] = orNull(v.evidence);
	line["centre_rmse"] = orNull(v.centreRmse);
	line["runner_up"] = orNull(v.runnerUp);
	line["alignment_fitness"] = orNull(v.alignmentFitness);
	line["alignment_rmse"] = orNull(v.alignmentRmse);
	if (record.driftSigmas) line["drift_sigmas"] = *record.driftSigmas;
	if (record.optimization)
		line["optimization"] = {
			{"initial_cost", record.optimization->initialCost},
			{"final_cost", record.optimization->finalCost},
			{"iterations", record.optimization->iterations},
			{"message", record.optimization->message}};
	return line;
}
}  // namespace

std::size_t countLoops(const std::vector<LoopRecord>& loops, LoopVerdict::Decision decision)
{
	return std::size_t(std::count_if(
		loops.begin(), loops.end(),
		[&](const LoopRecord& loop) { return loop.verdict.decision == decision; }));
}

std::string loopsAsJsonLines(const std::vector<LoopRecord>& loops)
{
	std::string text;
	for (const LoopRecord& record : loops) text += toJson(record).dump() + "\n";
	return text;
}

}  // namespace semloop
