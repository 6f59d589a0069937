#include "ObjectsCommand.h"

#include <semloop/config/Error.h>
#include <semloop/evaluation/ObjectEvaluation.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "Application.h"
#include "ObjectSurfaces.h"
#include "RunFolder.h"

namespace semloop
{
namespace
{
struct ObjectsArguments
{
	std::string folder;
	std::string truth;
	std::string groundTruth;  //!< empty: beside truth, by name
	std::string alignment;
	ObjectGate gate;
};

struct ObjectsResult
{
	ObjectEvaluation objects;
	SurfaceReport surface;
};

/** X_objects.json -> X_groundtruth.tum */
std::string groundTruthOf(const ObjectsArguments& arguments)
{
	if (!arguments.groundTruth.empty()) return arguments.groundTruth;
	const std::string ending = "_objects.json", &truth = arguments.truth;
	const auto stem = truth.size() - std::min(truth.size(), ending.size());
	if (truth.substr(stem) != ending)
		throw UsageError(
			"--groundtruth: missing, and " + truth + " is not named X" + ending +
			"; give the true trajectory, or --align none when both share a world");
	return truth.substr(0, stem) + "_groundtruth.tum";
}

mrpt::poses::CPose3D alignmentOf(const ObjectsArguments& arguments)
{
	if (arguments.alignment == "none") return {};
	const auto estimate = runFile(arguments.folder, "trajectory.tum");
	const auto truth = groundTruthOf(arguments);
	requireFile(
		truth,
		"give the true trajectory with --groundtruth, or --align none when both share a world");
	try
	{
		return absoluteTrajectoryError(
				   associateByTime(readTumTrajectory(estimate), readTumTrajectory(truth)))
			.T_truth_estimate;
	}
	catch (const InputError& e)
	{
		throw InputError(estimate + " with " + truth + ": " + e.what());
	}
}

ObjectsResult evaluate(const ObjectsArguments& arguments)
{
	const auto estimate = SemanticGraph::load(runFile(arguments.folder, "objects.json"));
	requireFile(arguments.truth, "give the true objects, semloop.graph/1");
	const auto truth = SemanticGraph::load(arguments.truth);
	const auto T_truth_estimate = alignmentOf(arguments);

	ObjectsResult result;
	result.objects = evaluateObjects(estimate, truth, T_truth_estimate, arguments.gate);
	result.surface =
		compareSurfaces(arguments.folder, arguments.truth, result.objects, T_truth_estimate);
	return result;
}

nlohmann::ordered_json toJson(const SurfaceReport& surface)
{
	auto json = nlohmann::ordered_json::object();
	json["objects"] = surface.objects;
	json["distance_m"] = nullptr;
	if (surface.objects > 0)
	{
		json["distance_m"] = toJson(surface.error.distance);
		json["distance_m"]["percentile_95"] = surface.error.percentile95;
	}
	if (!surface.note.empty()) json["note"] = surface.note;
	return json;
}

nlohmann::ordered_json toJson(const ObjectsResult& result)
{
	const ObjectEvaluation& o = result.objects;
	auto matches = nlohmann::ordered_json::array();
	for (const ObjectMatch& match : o.matches)
		matches.push_back(
			{{"object", match.estimate},
			 {"truth", match.truth},
			 {"centre_error_m", match.centreError},
			 {"box_iou", numberOrNull(match.boxIou)},
			 {"same_label", match.sameLabel}});
	return {
		{"objects", o.estimated},
		{"true_objects", o.truth},
		{"true_objects_found", o.found},
		{"precision", numberOrNull(o.precision)},
		{"recall", numberOrNull(o.recall)},
		{"duplicates", o.duplicates},
		{"centre_error_m", toJson(o.centreError)},
		{"mean_box_iou", numberOrNull(o.meanBoxIou)},
		{"label_accuracy", numberOrNull(o.labelAccuracy)},
		{"surface", toJson(result.surface)},
		{"matches", matches}};
}

void printTable(const ObjectsResult& result)
{
	const ObjectEvaluation& o = result.objects;
	std::printf(
		"%zu objects, %zu of them real; %zu of %zu real objects found; %zu duplicates\n\n",
		o.estimated, o.matches.size(), o.found, o.truth, o.duplicates.size());
	std::printf("%-22s %9s\n", "precision", toText(o.precision).c_str());
	std::printf("%-22s %9s\n", "recall", toText(o.recall).c_str());
	std::printf("%-22s %9s\n", "label accuracy", toText(o.labelAccuracy).c_str());
	std::printf("%-22s %9s\n\n", "mean box IoU", toText(o.meanBoxIou).c_str());

	std::printf("%-22s %9s %9s %9s %9s %9s\n", "error", "rmse", "mean", "median", "95 %", "max");
	const ErrorSummary& c = o.centreError;
	if (c.count > 0)
		std::printf(
			"%-22s %9.4f %9.4f %9.4f %9s %9.4f  m\n", "centre", c.rmse, c.mean, c.median, "",
			c.max);
	const ErrorSummary& s = result.surface.error.distance;
	if (s.count > 0)
		std::printf(
			"%-22s %9.4f %9.4f %9.4f %9.4f %9.4f  m\n", "surface", s.rmse, s.mean, s.median,
			result.surface.error.percentile95, s.max);
	if (!result.surface.note.empty()) std::printf("surface: %s\n", result.surface.note.c_str());
}
}  // namespace

int objectsCommand(int argc, char** argv)
{
	TCLAP::CmdLine commandLine(
		"Compares the objects of a run with the real ones: precision, recall, duplicates, error of "
		"the centres, overlap of the boxes, labels, and the surfaces where both have meshes.",
		' ', SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> folder(
		"folder", "where semloop-slam wrote its results", true, "", "OUT", commandLine);
	TCLAP::ValueArg<std::string> truth(
		"", "truth", "the real objects, semloop.graph/1; meshes are looked for in X_objects/", true,
		"", "X_objects.json", commandLine);
	TCLAP::ValueArg<std::string> groundTruth(
		"", "groundtruth", "the true trajectory (default: X_groundtruth.tum beside the truth)",
		false, "", "TRUTH.tum", commandLine);
	std::vector<std::string> choices{"se3", "none"};
	TCLAP::ValuesConstraint<std::string> alignments(choices);
	TCLAP::ValueArg<std::string> align(
		"", "align",
		"of the worlds: se3 = least squares over the trajectories (default), none = they are one",
		false, "se3", &alignments, commandLine);
	const ObjectGate defaults;
	TCLAP::ValueArg<double> maxDistance(
		"", "max-distance", "of the centres of a match [m] (default 0.5)", false,
		defaults.centreDistance, "METRES", commandLine);
	TCLAP::ValueArg<double> minIou(
		"", "min-iou", "further apart when the boxes overlap more than this (default 0.1)", false,
		defaults.boxIou, "SHARE", commandLine);
	TCLAP::SwitchArg json("", "json", "print JSON instead of the table", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return kSuccess;
	if (!(maxDistance.getValue() >= 0))
		throw UsageError("--max-distance: not allowed; use a number of metres >= 0");
	if (!(minIou.getValue() >= 0 && minIou.getValue() <= 1))
		throw UsageError("--min-iou: not allowed; use a number in [0, 1]");

	const auto result = evaluate(
		{folder.getValue(), truth.getValue(), groundTruth.getValue(), align.getValue(),
		 ObjectGate{maxDistance.getValue(), minIou.getValue()}});
	if (json.getValue())
		std::cout << toJson(result).dump(2) << "\n";
	else
		printTable(result);
	return kSuccess;
}

}  // namespace semloop
