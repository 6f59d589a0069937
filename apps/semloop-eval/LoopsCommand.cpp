#include "LoopsCommand.h"

#include <semloop/config/Error.h>
#include <semloop/evaluation/LoopEvaluation.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>

#include "Application.h"
#include "RunFolder.h"

namespace semloop
{
namespace
{
nlohmann::ordered_json toJson(const LoopCount& count)
{
	return {
		{"detections", count.detections},
		{"true_positives", count.truePositives},
		{"false_positives", count.falsePositives},
		{"precision", numberOrNull(count.precision)}};
}

nlohmann::ordered_json toJson(const LoopEvaluation& e, const LoopRule& rule)
{
	return {
		{"common_objects", rule.commonObjects},
		{"frames_apart", rule.framesApart},
		{"minimum_pixels", rule.minimumPixels},
		{"attempts", e.attempts},
		{"before_verification", toJson(e.detected)},
		{"after_verification", toJson(e.verified)},
		{"loop_frames", e.loopFrames},
		{"places", e.places},
		{"places_found", e.placesFound},
		{"recall", numberOrNull(e.recall)}};
}

void printRow(const char* name, const LoopCount& c)
{
	std::printf(
		"%-22s %10zu %8zu %8zu %10s\n", name, c.detections, c.truePositives, c.falsePositives,
		toText(c.precision).c_str());
}

void printTable(const LoopEvaluation& e, const LoopRule& rule)
{
	std::printf(
		"a loop: more than %zu objects in common, more than %zu frames apart\n\n",
		rule.commonObjects, rule.framesApart);
	std::printf("%-22s %10s %8s %8s %10s\n", "", "detections", "true", "false", "precision");
	printRow("before verification", e.detected);
	printRow("after verification", e.verified);
	std::printf(
		"\n%zu of %zu places found (%zu frames are a loop with an earlier one); recall %s\n",
		e.placesFound, e.places, e.loopFrames, toText(e.recall).c_str());
}

std::size_t countOf(TCLAP::ValueArg<int>& argument)
{
	if (argument.getValue() < 0)
		throw UsageError("--" + argument.getName() + ": not allowed; use a number >= 0");
	return std::size_t(argument.getValue());
}

LoopEvaluation evaluate(const std::string& loops, const std::string& truth, const LoopRule& rule)
{
	requireFile(loops, "give the loops.jsonl that semloop-slam wrote");
	const auto attempts = readLoopAttempts(loops);
	const auto folder = std::filesystem::absolute(loops).parent_path().string();
	return evaluateLoops(attempts, runWithTruth(folder, truth), rule);
}
}  // namespace

int loopsCommand(int argc, char** argv)
{
	TCLAP::CmdLine commandLine(
		"Measures the loop detection of a run. Needs trajectory.tum and associations.csv beside "
		"the "
		"loops.",
		' ', SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> loops(
		"loops", "what semloop-slam wrote", true, "", "OUT/loops.jsonl", commandLine);
	TCLAP::ValueArg<std::string> truth(
		"", "truth", "rawlog of the true instances", true, "", "INSTANCES.rawlog", commandLine);
	TCLAP::ValueArg<int> commonObjects(
		"", "common-objects", "two frames with more objects in common are a loop (default 2)",
		false, 2, "N", commandLine);
	TCLAP::ValueArg<int> framesApart(
		"", "frames-apart", "when they are more frames apart (default 500)", false, 500, "N",
		commandLine);
	TCLAP::ValueArg<int> minimumPixels(
		"", "minimum-pixels", "objects with a smaller mask are not in the frame (default 0)", false,
		0, "PIXELS", commandLine);
	TCLAP::SwitchArg json("", "json", "print JSON instead of the table", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return kSuccess;

	const LoopRule rule{countOf(commonObjects), countOf(framesApart), countOf(minimumPixels)};
	const auto result = evaluate(loops.getValue(), truth.getValue(), rule);
	if (json.getValue())
		std::cout << toJson(result, rule).dump(2) << "\n";
	else
		printTable(result, rule);
	return kSuccess;
}

}  // namespace semloop
