#include <semloop/config/Error.h>
#include <semloop/loop_closure/OrbFeatures.h>
#include <semloop/loop_closure/OrbVocabulary.h>
#include <semloop/observations/RawlogReader.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <vector>

#include "Application.h"
#include "ProgressBar.h"
#include "StopSignal.h"

namespace
{
using namespace semloop;

const char* const kName = "rawlog-train-vocabulary";

struct Arguments
{
	std::vector<std::string> rawlogs;
	std::string output;
	OrbVocabularyOptions vocabulary;
	int every = 10, features = 1000, maxImages = 2000;
};

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, Arguments& arguments)
{
	using Number = TCLAP::ValueArg<int>;
	TCLAP::CmdLine line(
		"Trains a vocabulary of ORB words on the colour images of rawlogs, for "
		"semloop::BagOfWordsLoopDetector.",
		' ', SEMLOOP_VERSION);
	Number seed("", "seed", "Of the clustering.", false, 1, "N", line);
	Number maxImages(
		"", "max-images", "More are an error: a larger --every takes fewer.", false, 2000, "N",
		line);
	Number features("", "features", "Of an image at most.", false, 1000, "N", line);
	Number every("", "every", "Only every n-th image.", false, 10, "N", line);
	Number levels("", "levels", "Of the tree, 1 to 8.", false, 4, "N", line);
	Number branching("", "branching", "Children of a node, 2 to 100.", false, 10, "N", line);
	TCLAP::SwitchArg force("", "force", "Replace the file when it is there.", line);
	TCLAP::ValueArg<std::string> out(
		"o", "out", "Where to write.", true, "", "OUT.vocabulary", line);
	TCLAP::UnlabeledMultiArg<std::string> rawlogs(
		"rawlogs", "Rawlogs with CObservation3DRangeScan.", true, "IN.rawlog", line);
	if (!parseArguments(line, argc, argv)) return false;

	const auto require = [](Number& number, int least, int most)
	{
		if (number.getValue() < least || number.getValue() > most)
			throw UsageError(
				"--" + number.getName() + " must lie in [" + std::to_string(least) + ", " +
				std::to_string(most) + "]");
	};
	require(seed, 0, 1000000000);
	require(maxImages, 2, 1000000);
	require(features, 10, 100000);
	require(every, 1, 1000000);
	require(levels, 1, 8);
	require(branching, 2, 100);
	if (std::filesystem::exists(out.getValue()) && !force.getValue())
		throw UsageError(out.getValue() + " is there already; --force replaces it");
	arguments.rawlogs = rawlogs.getValue();
	arguments.output = out.getValue();
	arguments.vocabulary.branching = branching.getValue();
	arguments.vocabulary.levels = levels.getValue();
	arguments.vocabulary.seed = unsigned(seed.getValue());
	arguments.every = every.getValue();
	arguments.features = features.getValue();
	arguments.maxImages = maxImages.getValue();
	return true;
}

/** Adds the descriptors of each image that is used. */
void describeImages(
	const std::string& rawlog, const Arguments& arguments, std::vector<cv::Mat>& images)
{
	RawlogReader reader(rawlog);
	ProgressBar bar("describing");
	std::size_t scans = 0, frames = 0;
	while (const auto observation = reader.next())
	{
		if (stopRequested()) throw InputError("stopped; nothing was written");
		const auto* scan =
			dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get());
		if (!scan || scans++ % std::size_t(arguments.every) != 0) continue;
		try
		{
			images.push_back(extractOrb(rgbdFrameFrom(*scan), arguments.features).descriptors);
		}
		catch (const InputError& error)
		{
			bar.clear();
			std::cerr << kName << ": warning: " << rawlog
					  << ": an image is left out: " << error.what() << "\n";
			continue;
		}
		if (int(images.size()) > arguments.maxImages)
			throw InputError(
				"more than " + std::to_string(arguments.maxImages) +
				" images; use a larger --every, or --max-images");
		bar.update(++frames, reader.progress());
	}
	bar.clear();
	if (scans == 0)
		throw InputError(rawlog + ": holds no CObservation3DRangeScan: is it an RGB-D rawlog?");
}

int run(int argc, char** argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments)) return kSuccess;
	for (const auto& rawlog : arguments.rawlogs)
		requireFile(rawlog, "make one with tum2rawlog, or correct the path");
	catchStopSignal();
	std::vector<cv::Mat> images;
	for (const auto& rawlog : arguments.rawlogs) describeImages(rawlog, arguments, images);
	std::size_t descriptors = 0;
	for (const auto& image : images) descriptors += std::size_t(image.rows);
	const auto vocabulary = OrbVocabulary::train(images, arguments.vocabulary);
	vocabulary.save(arguments.output);
	std::printf(
		"%s: %zu words of %zu features in %zu images\n", arguments.output.c_str(),
		vocabulary.words(), descriptors, images.size());
	return kSuccess;
}
}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
