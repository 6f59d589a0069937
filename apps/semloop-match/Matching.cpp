#include "Matching.h"

#include <chrono>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "GraphInput.h"

namespace semloop
{
TimedVerdict timedMatch(
	const PlaceRecognizer& recognizer, const SemanticGraph& query, const SemanticGraph& target,
	const GraphIndex& index, const std::optional<PosePrior>& prior)
{
	using Clock = std::chrono::steady_clock;
	const auto start = Clock::now();
	TimedVerdict result;
	result.verdict = recognizer.recognize(query, target, index, prior);
	result.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
	return result;
}

void printForPerson(std::ostream& out, const TimedVerdict& result)
{
	const LoopVerdict& verdict = result.verdict;
	out << toString(verdict.decision) << ": " << verdict.reason << "\n" << std::fixed;
	if (!verdict.matches.empty())
	{
		out << "matches (query - target):";
		const char* separator = " ";
		for (const auto& [query, target] : verdict.matches)
			out << std::exchange(separator, ", ") << query << " - " << target;
		out << "\n";
	}
	if (verdict.hasPose)
	{
		out << "T_target_query:\n" << std::setprecision(6);
		const auto matrix = matrixFromPose(verdict.T_target_query);
		for (std::size_t i = 0; i < matrix.size(); ++i)
			out << std::setw(13) << matrix[i] << (i % 4 == 3 ? "\n" : "");
	}
	out << std::setprecision(3) << "runner-up " << verdict.runnerUp.value_or(0) << ", probability "
		<< verdict.probability << ", " << result.milliseconds << " ms\n";
}

void printJson(std::ostream& out, const TimedVerdict& result)
{
	const LoopVerdict& verdict = result.verdict;
	nlohmann::ordered_json document;
	document["decision"] = toString(verdict.decision);
	document["reason"] = verdict.reason;
	document["matches"] = verdict.matches;
	if (verdict.hasPose)
		document["T_target_query"] = matrixFromPose(verdict.T_target_query);
	else
		document["T_target_query"] = nullptr;
	document["inliers"] = verdict.matches.size();
	document["runner_up"] = verdict.runnerUp.value_or(0);
	document["probability"] = verdict.probability;
	document["milliseconds"] = result.milliseconds;
	out << document.dump() << "\n";
}

}  // namespace semloop
