#include <semloop/association/ConfusionMatrix.h>
#include <semloop/config/Error.h>

#include <iomanip>
#include <iostream>

#include "Application.h"
#include "LabelPairs.h"

namespace
{
int run(int argc, char** argv)
{
	TCLAP::CmdLine commandLine(
		"Learns p(observed label | true label) of a segmentation network from labelled pairs, for "
		"the association's matching cost.",
		' ', SEMLOOP_VERSION);
	TCLAP::ValueArg<double> smoothing(
		"", "smoothing", "Count that every pair begins with (ten times that when right)", false,
		0.1, "NUMBER", commandLine);
	TCLAP::ValueArg<std::string> labelFile(
		"", "labels", "The network's label names, one a line (default: the 80 of COCO)", false, "",
		"FILE", commandLine);
	TCLAP::UnlabeledValueArg<std::string> pairs(
		"pairs", "CSV lines true,observed[,count] by label name; # begins a comment", true, "",
		"PAIRS.csv", commandLine);
	TCLAP::UnlabeledValueArg<std::string> output(
		"output", "The confusion matrix to write", true, "", "OUT.json", commandLine);
	if (!semloop::parseArguments(commandLine, argc, argv)) return semloop::kSuccess;
	if (!(smoothing.getValue() > 0 && smoothing.getValue() <= 1e6))
		throw semloop::UsageError("--smoothing: not allowed; use a number > 0 and <= 1000000");

	const auto labels = labelFile.isSet() ? semloop::LabelSet::fromFile(labelFile.getValue())
										  : semloop::LabelSet::coco();
	const auto counts = semloop::countLabelPairs(pairs.getValue(), labels);
	semloop::ConfusionMatrix::learnFromCounts(labels, counts, smoothing.getValue())
		.save(output.getValue());
	std::cout << output.getValue() << ": " << labels.size() << " labels from "
			  << std::size_t(counts.sum()) << " pairs, " << std::fixed << std::setprecision(1)
			  << 100 * counts.trace() / counts.sum() << " % of them right\n";
	return semloop::kSuccess;
}
}  // namespace

int main(int argc, char** argv)
{
	return semloop::runApplication("semloop-learn-confusion", [&] { return run(argc, argv); });
}
