#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <vector>

#include "Application.h"
#include "ProgressBar.h"
#include "SegmentRawlog.h"
#include "Settings.h"
#include "Sidecar.h"
#include "StopSignal.h"

namespace
{
using namespace semloop;

const char* const kName = "rawlog-segment";

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, Arguments& arguments)
{
	TCLAP::CmdLine commandLine(
		"Finds the objects in every colour image of an RGB-D rawlog with a segmentation network "
		"and "
		"writes them to a rawlog beside it.",
		' ', SEMLOOP_VERSION);
	using Text = TCLAP::ValueArg<std::string>;
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog", "Rawlog with CObservation3DRangeScan.", true, "", "IN.rawlog", commandLine);
	TCLAP::SwitchArg force("", "force", "Make it anew even when it is there.", commandLine);
	TCLAP::SwitchArg depthCrops(
		"", "depth-crops", "Store the depth inside each object's box too.", commandLine);
	TCLAP::ValueArg<int> every("", "every", "Only every n-th frame.", false, 1, "N", commandLine);
	TCLAP::MultiArg<std::string> set(
		"", "set", "Any option, e.g. segmentation.max_iou=0.6 or embedding.mean=0.", false,
		"section.key=value", commandLine);
	TCLAP::ValueArg<double> score(
		"", "score", "Lowest score of a detection (segmentation.min_score).", false, -1, "0..1",
		commandLine);
	Text out(
		"", "out", "Where to write; without, IN_instances.rawlog.", false, "", "X.rawlog",
		commandLine);
	Text labels(
		"", "labels", "The network's labels, one a line; without, COCO's.", false, "", "FILE",
		commandLine);
	Text embeddingModel(
		"", "embedding-model", "Network for the objects' appearance; without, colour histograms.",
		false, "", "E.onnx", commandLine);
	Text modelConfig(
		"", "model-config", "Graph description of a TensorFlow network.", false, "", "M.pbtxt",
		commandLine);
	Text model(
		"", "model", "Segmentation network, see doc/segmentation-networks.md.", true, "", "M.onnx",
		commandLine);
	if (!parseArguments(commandLine, argc, argv)) return false;

	if (every.getValue() < 1) throw UsageError("--every must be at least 1");
	if (score.isSet() && !(score.getValue() >= 0 && score.getValue() <= 1))
		throw UsageError("--score must lie in [0, 1]");
	arguments.rawlog = rawlog.getValue();
	arguments.model = model.getValue();
	arguments.modelConfig = modelConfig.getValue();
	arguments.embeddingModel = embeddingModel.getValue();
	arguments.labels = labels.getValue();
	arguments.output = out.isSet() ? out.getValue() : instancesSidecarPath(arguments.rawlog);
	arguments.minScore = score.getValue();
	arguments.overrides = set.getValue();
	arguments.every = every.getValue();
	arguments.depthCrops = depthCrops.getValue();
	arguments.force = force.getValue();
	return true;
}

void printSummary(const std::string& path, const SidecarContents& contents, std::size_t skipped)
{
	std::printf(
		"%s: %zu frames, %zu skipped, %zu instances\n", path.c_str(), contents.times.size(),
		skipped, contents.instanceCount());
	std::vector<std::pair<std::string, std::size_t>> labels(
		contents.instancesOfLabel.begin(), contents.instancesOfLabel.end());
	std::stable_sort(
		labels.begin(), labels.end(),
		[](const auto& a, const auto& b) { return a.second > b.second; });
	for (const auto& [label, count] : labels) std::printf("%8zu %s\n", count, label.c_str());
}

int run(int argc, char** argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments)) return kSuccess;
	requireFile(arguments.rawlog, "make one with tum2rawlog, or correct the path");
	std::error_code error;
	if (std::filesystem::equivalent(arguments.rawlog, arguments.output, error))
		throw UsageError("--out " + arguments.output + " is the rawlog itself; name another file");
	catchStopSignal();

	Networks networks = loadNetworks(arguments);
	Sidecar sidecar(arguments.output, networks.settings, arguments.force);
	if (sidecar.isComplete())
	{
		std::cerr << kName << ": " << arguments.output
				  << " is there already, with these settings\n";
		printSummary(arguments.output, sidecar.contents(), 0);
		return kSuccess;
	}
	if (sidecar.resumedFrames() > 0)
		std::cerr << kName << ": goes on after " << sidecar.resumedFrames()
				  << " frames of an interrupted run\n";

	ProgressBar bar("segmenting");
	const auto warn = [&](const std::string& line)
	{
		bar.clear();
		std::cerr << kName << ": warning: " << line << "\n";
	};
	const auto report = segmentRawlog(
		arguments, networks, sidecar,
		{[&](std::size_t frames, double share) { bar.update(frames, share); }, warn,
		 stopRequested});
	bar.clear();

	if (report.stopped)
		throw InputError(
			"stopped after " + std::to_string(sidecar.contents().times.size()) +
			" frames, which are kept in " + RawlogWriter::partialPath(arguments.output) +
			"; run the same command again to go on");
	if (sidecar.contents().times.empty())
		throw InputError(
			!report.inputDamage.empty() ? report.inputDamage
			: report.frames > 0
				? arguments.rawlog + ": none of its frames could be used"
				: arguments.rawlog + ": holds no CObservation3DRangeScan: is it an RGB-D rawlog?");
	printSummary(arguments.output, sidecar.contents(), report.skipped);
	if (!report.inputDamage.empty()) throw InputError(report.inputDamage);
	return kSuccess;
}
}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
