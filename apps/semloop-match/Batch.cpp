#include "Batch.h"

#include <semloop/config/Error.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "GraphInput.h"
#include "Matching.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using json = nlohmann::json;
using mrpt::poses::CPose3D;

constexpr double kMaxCentreError = 0.4;    // of a right pose [m]
constexpr double kMaxRotationError = 0.2;  // same [rad]

struct Problem
{
	std::string query, target;  //!< files
	bool negative = false;
	std::optional<CPose3D> T_target_query;
	std::map<ObjectId, ObjectId> matches;
	std::optional<PosePrior> prior;
};

std::vector<Problem> readProblems(const fs::path& folder)
{
	const std::string path = (folder / "truth.json").string();
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be read; give a folder of matching problems");
	std::vector<Problem> problems;
	std::size_t number = 0;
	try
	{
		for (const auto& entry : json::parse(file))
		{
			const std::string place = path + ": problem " + std::to_string(number++);
			Problem problem;
			problem.query = (folder / entry.at("query").get<std::string>()).string();
			problem.target = (folder / entry.at("target").get<std::string>()).string();
			problem.negative = entry.at("negative").get<bool>();
			if (!problem.negative)
				problem.T_target_query = poseFromMatrix(
					entry.at("T_target_query").get<std::vector<double>>(),
					place + ": T_target_query");
			for (const auto& [query, target] :
				 entry.at("matches").get<std::vector<std::pair<ObjectId, ObjectId>>>())
				problem.matches[query] = target;
			if (entry.contains("prior"))
			{
				PosePrior prior;
				prior.T_target_query =
					poseFromMatrix(entry.at("prior").get<std::vector<double>>(), place + ": prior");
				if (entry.contains("prior_sigma"))
				{
					const auto& sigma = entry.at("prior_sigma");
					prior.sigmaXY = sigma.at("xy").get<double>();
					prior.sigmaZ = sigma.at("z").get<double>();
					prior.sigmaYaw = sigma.at("yaw").get<double>();
				}
				problem.prior = prior;
			}
			problems.push_back(std::move(problem));
		}
	}
	catch (const json::exception& error)
	{
		throw InputError(
			path + ": problem " + std::to_string(number) + ": " + error.what() +
			"; write it again");
	}
	return problems;
}

bool isRight(const SemanticGraph& query, const CPose3D& estimate, const CPose3D& truth)
{
	mrpt::math::TPoint3D centre;
	for (const auto& vertex : query.vertices) centre += vertex.position;
	centre *= 1.0 / double(std::max<std::size_t>(1, query.vertices.size()));
	const auto turn = (estimate - truth).getRotationMatrix();
	const double angle = std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0));
	return (estimate.composePoint(centre) - truth.composePoint(centre)).norm() < kMaxCentreError &&
		   angle < kMaxRotationError;
}

void count(
	const Problem& problem, const SemanticGraph& query, const LoopVerdict& verdict,
	ScenarioResult& result)
{
	const bool accepted = verdict.decision == LoopVerdict::Decision::Accepted;
	result.accepted += accepted;
	result.ambiguous += verdict.decision == LoopVerdict::Decision::Ambiguous;
	if (problem.negative)
	{
		++result.negatives;
		result.acceptedForeign += accepted;
		return;
	}
	++result.positives;
	const bool right =
		verdict.hasPose && isRight(query, verdict.T_target_query, *problem.T_target_query);
	result.rightPoses += right;
	result.acceptedRight += right && accepted;
	result.trueMatches += problem.matches.size();
	result.matches += verdict.matches.size();
	for (const auto& [from, to] : verdict.matches)
		if (const auto found = problem.matches.find(from); found != problem.matches.end())
			result.rightMatches += found->second == to;
}

ScenarioResult runScenario(const fs::path& folder, const PlaceRecognizer& recognizer, bool usePrior)
{
	ScenarioResult result;
	result.name = fs::absolute(folder).lexically_normal().filename().string();
	std::string targetFile;
	SemanticGraph target;
	std::optional<GraphIndex> index;
	for (const auto& problem : readProblems(folder))
	{
		if (problem.target != targetFile)
		{
			target = readGraph(problem.target);
			index.emplace(target);
			targetFile = problem.target;
		}
		const auto query = readGraph(problem.query);
		const auto timed =
			timedMatch(recognizer, query, target, *index, usePrior ? problem.prior : std::nullopt);
		result.milliseconds.push_back(timed.milliseconds);
		count(problem, query, timed.verdict, result);
	}
	return result;
}

/** In percent; empty when nothing was counted. */
std::optional<double> percent(std::size_t part, std::size_t whole)
{
	if (whole == 0) return {};
	return 100.0 * double(part) / double(whole);
}

double quantile(std::vector<double> values, double share)
{
	if (values.empty()) return 0;
	std::sort(values.begin(), values.end());
	return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

/** The columns of the table, with their keys. */
std::vector<std::pair<std::string, std::optional<double>>> figures(const ScenarioResult& r)
{
	return {
		{"pose_success", percent(r.rightPoses, r.positives)},
		{"precision", percent(r.acceptedRight, r.accepted)},
		{"recall", percent(r.acceptedRight, r.positives)},
		{"false_loops", percent(r.acceptedForeign, r.negatives)},
		{"vertex_precision", percent(r.rightMatches, r.matches)},
		{"vertex_recall", percent(r.rightMatches, r.trueMatches)},
		{"median_ms", quantile(r.milliseconds, 0.5)},
		{"p95_ms", quantile(r.milliseconds, 0.95)}};
}
}  // namespace

std::vector<ScenarioResult> runBatch(
	const std::string& folder, const PlaceRecognizer& recognizer, bool usePrior)
{
	std::vector<fs::path> scenarios;
	if (fs::exists(fs::path(folder) / "truth.json"))
		scenarios.push_back(folder);
	else if (fs::is_directory(folder))
		for (const auto& entry : fs::directory_iterator(folder))
			if (fs::exists(entry.path() / "truth.json")) scenarios.push_back(entry.path());
	if (scenarios.empty())
		throw InputError(
			folder +
			": has no truth.json, nor has any folder in it; give a folder of matching problems");
	std::sort(scenarios.begin(), scenarios.end());
	std::vector<ScenarioResult> results;
	for (const auto& scenario : scenarios)
		results.push_back(runScenario(scenario, recognizer, usePrior));
	return results;
}

void printTable(std::ostream& out, const std::vector<ScenarioResult>& results)
{
	out << "scenario              problems  pose %  precision %  recall %  false/100  ambiguous  "
		   "vertices: precision %  recall %  median ms  95 % ms\n"
		<< std::fixed;
	for (const auto& result : results)
	{
		const auto columns = figures(result);
		const auto cell = [&](std::size_t column, int width, int digits)
		{
			out << std::setw(width) << std::setprecision(digits);
			if (columns[column].second)
				out << *columns[column].second;
			else
				out << "-";
		};
		out << std::left << std::setw(22) << result.name << std::right << std::setw(8)
			<< result.positives + result.negatives;
		cell(0, 8, 1);
		cell(1, 13, 1);
		cell(2, 10, 1);
		cell(3, 11, 1);
		out << std::setw(11) << result.ambiguous;
		cell(4, 23, 1);
		cell(5, 10, 1);
		cell(6, 11, 3);
		cell(7, 9, 3);
		out << "\n";
	}
}

void printJson(std::ostream& out, const std::vector<ScenarioResult>& results)
{
	nlohmann::ordered_json document = nlohmann::ordered_json::object();
	for (const auto& result : results)
	{
		auto& scenario = document[result.name];
		scenario["positives"] = result.positives;
		scenario["negatives"] = result.negatives;
		scenario["ambiguous"] = result.ambiguous;
		for (const auto& [key, value] : figures(result))
			if (value)
				scenario[key] = *value;
			else
				scenario[key] = nullptr;
	}
	out << document.dump(1) << "\n";
}

}  // namespace semloop
