#include "AssociationCommand.h"

#include <semloop/config/Error.h>
#include <semloop/evaluation/AssociationAccuracy.h>

#include <cstdio>
#include <iostream>
#include <string>

#include "Application.h"
#include "RunFolder.h"

namespace semloop
{
namespace
{
nlohmann::ordered_json toJson(const AssociationAccuracy& a)
{
	auto matches = nlohmann::ordered_json::array();
	for (const IdentityMatch& match : a.matches)
		matches.push_back(
			{{"truth", match.truth},
			 {"object", match.estimate},
			 {"shared_boxes", match.sharedBoxes}});
	return {
		{"frames", a.frames},
		{"true_boxes", a.trueBoxes},
		{"detected_boxes", a.detectedBoxes},
		{"correct", a.correct},
		{"accuracy", numberOrNull(a.accuracy)},
		{"accuracy_of_detected", numberOrNull(a.accuracyOfDetected)},
		{"matches", matches}};
}

void printTable(const AssociationAccuracy& a)
{
	std::printf("%zu frames of the run have a truth\n\n", a.frames);
	std::printf("%-32s %8zu\n", "true boxes", a.trueBoxes);
	std::printf("%-32s %8zu\n", "of these in the map", a.detectedBoxes);
	std::printf("%-32s %8zu\n", "of these in the right object", a.correct);
	std::printf("%-32s %8s\n", "accuracy", toText(a.accuracy).c_str());
	std::printf(
		"%-32s %8s\n", "accuracy of those in the map", toText(a.accuracyOfDetected).c_str());
}
}  // namespace

int associationCommand(int argc, char** argv)
{
	TCLAP::CmdLine commandLine(
		"Measures the data association of a run: the share of the true boxes that went into the "
		"object that stands for the real one.",
		' ', SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> folder(
		"folder", "where semloop-slam wrote its results", true, "", "OUT", commandLine);
	TCLAP::ValueArg<std::string> truth(
		"", "truth", "rawlog of the true instances", true, "", "INSTANCES.rawlog", commandLine);
	TCLAP::ValueArg<int> minimumPixels(
		"", "minimum-pixels", "true boxes with a smaller mask do not count (default 0)", false, 0,
		"PIXELS", commandLine);
	TCLAP::ValueArg<std::string> images(
		"", "images",
		"rawlog that the run was made of: only pixels whose depth was measured count as mask",
		false, "", "IN.rawlog", commandLine);
	TCLAP::SwitchArg json("", "json", "print JSON instead of the table", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return kSuccess;
	if (minimumPixels.getValue() < 0)
		throw UsageError("--minimum-pixels: not allowed; use a number of pixels >= 0");

	const auto result = associationAccuracy(
		runWithTruth(folder.getValue(), truth.getValue(), images.getValue()),
		std::size_t(minimumPixels.getValue()));
	if (json.getValue())
		std::cout << toJson(result).dump(2) << "\n";
	else
		printTable(result);
	return kSuccess;
}

}  // namespace semloop
