#include <semloop/config/Error.h>

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "Application.h"
#include "ProgressBar.h"
#include "TumCamera.h"
#include "TumImport.h"

namespace
{
using namespace semloop;

const char* const kName = "tum2rawlog";

mrpt::img::TCamera chooseCamera(const std::string& option, const std::string& directory)
{
	if (!option.empty()) return tumCamera(option);
	const auto guess = guessTumCamera(directory);
	if (!guess && std::filesystem::is_directory(directory))
		std::cerr << kName << ": the folder's name does not tell the camera, taking ros (fx = fy = "
				  << "525, no distortion); use --camera for another\n";
	return tumCamera(guess.value_or("ros"));
}

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, TumImport& import)
{
	TCLAP::CmdLine commandLine(
		"Turns a sequence of the TUM RGB-D benchmark into a rawlog, depth bit by bit.", ' ',
		SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> directory(
		"directory", "Folder with rgb.txt, depth.txt and the images.", true, "", "DIR",
		commandLine);
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog",
		"Rawlog to write; its images go to OUT_Images/, the ground truth to "
		"OUT_groundtruth.tum.",
		true, "", "OUT.rawlog", commandLine);
	TCLAP::SwitchArg embed("", "embed", "Images inside the rawlog, lossless.", commandLine);
	TCLAP::ValueArg<double> maxTimeDifference(
		"", "max-time-difference",
		"Largest difference in time of a colour and a depth image [s], 0.02 unless given.", false,
		0.02, "SECONDS", commandLine);
	TCLAP::ValueArg<std::string> camera(
		"", "camera",
		"Published camera of the benchmark or a file with MRPT's TCamera; guessed from the "
		"folder's "
		"name unless given.",
		false, "", "fr1|fr2|fr3|ros|FILE.ini", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return false;

	const double difference = maxTimeDifference.getValue();
	if (!(difference >= 0 && difference <= 1))
		throw UsageError("--max-time-difference must lie in [0, 1] seconds");
	import.directory = directory.getValue();
	import.rawlog = rawlog.getValue();
	import.embed = embed.getValue();
	import.maxTimeDifference = difference;
	import.camera = chooseCamera(camera.getValue(), import.directory);
	return true;
}

int run(int argc, char** argv)
{
	TumImport import;
	if (!parse(argc, argv, import)) return kSuccess;
	ProgressBar bar("converting");
	const auto report =
		importTum(import, [&](std::size_t frames, double share) { bar.update(frames, share); });
	bar.clear();
	std::printf(
		"%s: %zu pairs (camera %s), %zu colour and %zu depth images without partner, %zu "
		"ground-truth poses, %zu accelerations\n",
		import.rawlog.c_str(), report.pairs, import.camera.cameraName.c_str(), report.unpairedColor,
		report.unpairedDepth, report.groundTruthPoses, report.accelerations);
	return kSuccess;
}

}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
