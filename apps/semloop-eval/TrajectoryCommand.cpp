#include "TrajectoryCommand.h"

#include <semloop/config/Error.h>
#include <semloop/evaluation/TrajectoryError.h>

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

#include "Application.h"
#include "RunFolder.h"

namespace semloop
{
namespace
{
constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

struct Evaluation
{
	std::size_t estimatedPoses = 0;
	std::size_t truePoses = 0;
	AbsoluteTrajectoryError absolute;
	RelativePoseError perSecond;
	RelativePoseError perMetre;
};

struct TrajectoryArguments
{
	std::string estimate;
	std::string truth;
	std::string alignment;
	double maxTimeDifference = 0;
	bool json = false;
};

Trajectory readTrajectory(const std::string& path)
{
	requireFile(path, "give a trajectory in TUM format");
	return readTumTrajectory(path);
}

Evaluation evaluate(const TrajectoryArguments& arguments)
{
	const auto estimate = readTrajectory(arguments.estimate);
	const auto truth = readTrajectory(arguments.truth);
	const auto pairs = associateByTime(estimate, truth, arguments.maxTimeDifference);

	Evaluation result;
	result.estimatedPoses = estimate.size();
	result.truePoses = truth.size();
	try
	{
		result.absolute = absoluteTrajectoryError(
			pairs,
			arguments.alignment == "se3" ? TrajectoryAlignment::Se3 : TrajectoryAlignment::None);
		result.perSecond = relativePoseError(pairs, 1.0, IntervalUnit::Seconds);
		result.perMetre = relativePoseError(pairs, 1.0, IntervalUnit::Metres);
	}
	catch (const InputError& e)
	{
		throw InputError(arguments.estimate + " with " + arguments.truth + ": " + e.what());
	}
	return result;
}

nlohmann::ordered_json toJson(const RelativePoseError& error)
{
	return {
		{"interval", error.interval},
		{"translation_m", toJson(error.translation)},
		{"rotation_deg", toJson(error.rotation, kDegreesPerRadian)}};
}

nlohmann::ordered_json toJson(const Evaluation& e, const TrajectoryArguments& arguments)
{
	return {
		{"estimate", arguments.estimate},
		{"truth", arguments.truth},
		{"align", arguments.alignment},
		{"poses", {{"estimate", e.estimatedPoses}, {"truth", e.truePoses}}},
		{"pairs", e.absolute.translation.count},
		{"ate_m", toJson(e.absolute.translation)},
		{"rpe_per_second", toJson(e.perSecond)},
		{"rpe_per_metre", toJson(e.perMetre)}};
}

void printRow(const char* name, const ErrorSummary& s, double scale, const char* unit)
{
	if (s.count == 0)
		std::printf("%-22s %7s  the trajectory is too short\n", name, "0");
	else
		std::printf(
			"%-22s %7zu %9.4f %9.4f %9.4f %9.4f  %s\n", name, s.count, s.rmse * scale,
			s.mean * scale, s.median * scale, s.max * scale, unit);
}

void printTable(const Evaluation& e, const TrajectoryArguments& arguments)
{
	std::printf(
		"%zu of %zu estimated poses have a true one; alignment: %s\n\n",
		e.absolute.translation.count, e.estimatedPoses, arguments.alignment.c_str());
	std::printf("%-22s %7s %9s %9s %9s %9s\n", "error", "count", "rmse", "mean", "median", "max");
	printRow("absolute", e.absolute.translation, 1, "m");
	printRow("relative, 1 s", e.perSecond.translation, 1, "m");
	printRow("", e.perSecond.rotation, kDegreesPerRadian, "deg");
	printRow("relative, 1 m", e.perMetre.translation, 1, "m");
	printRow("", e.perMetre.rotation, kDegreesPerRadian, "deg");
}
}  // namespace

int trajectoryCommand(int argc, char** argv)
{
	TCLAP::CmdLine commandLine(
		"Compares an estimated trajectory with the true one, both in TUM format: absolute "
		"trajectory error, and relative pose error over a second and over a metre.",
		' ', SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> estimate(
		"estimate", "the estimated trajectory", true, "", "EST.tum", commandLine);
	TCLAP::UnlabeledValueArg<std::string> truth(
		"truth", "the true trajectory", true, "", "TRUTH.tum", commandLine);
	std::vector<std::string> choices{"se3", "none"};
	TCLAP::ValuesConstraint<std::string> alignments(choices);
	TCLAP::ValueArg<std::string> align(
		"", "align",
		"before the absolute error: se3 = least squares over rotation and translation (default), "
		"none = both share a world",
		false, "se3", &alignments, commandLine);
	TCLAP::ValueArg<double> maxTimeDifference(
		"", "max-time-difference", "between the two poses of a pair [s] (default 0.02)", false,
		0.02, "SECONDS", commandLine);
	TCLAP::SwitchArg json("", "json", "print JSON instead of the table", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return kSuccess;
	if (!(maxTimeDifference.getValue() >= 0))
		throw UsageError("--max-time-difference: not allowed; use a number of seconds >= 0");

	const TrajectoryArguments arguments{
		estimate.getValue(), truth.getValue(), align.getValue(), maxTimeDifference.getValue(),
		json.getValue()};
	const auto result = evaluate(arguments);
	if (arguments.json)
		std::cout << toJson(result, arguments).dump(2) << "\n";
	else
		printTable(result, arguments);
	return kSuccess;
}

}  // namespace semloop
