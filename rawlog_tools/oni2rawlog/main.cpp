#include <semloop/config/Error.h>
#include <semloop/observations/UnixTime.h>

#include <cstdio>

#include "Application.h"
#include "OniImport.h"
#include "ProgressBar.h"

namespace
{
using namespace semloop;

const char* const kName = "oni2rawlog";

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, OniImport& import)
{
	TCLAP::CmdLine commandLine(
		"Turns a recording of OpenNI2 (*.oni) into a rawlog, depth bit by bit.", ' ',
		SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> recording(
		"recording", "Recording with depth and colour.", true, "", "IN.oni", commandLine);
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog", "Rawlog to write; its images go to OUT_Images/.", true, "", "OUT.rawlog",
		commandLine);
	TCLAP::SwitchArg embed("", "embed", "Images inside the rawlog.", commandLine);
	TCLAP::ValueArg<std::string> camera(
		"", "camera",
		"File with MRPT's TCamera; without it intrinsics are as the recording's field of view "
		"tells.",
		false, "", "FILE.ini", commandLine);
	TCLAP::ValueArg<std::string> startTime(
		"", "start-time",
		"Unix time of the first frame [s]; when the recording was last changed, unless given.",
		false, "", "T", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return false;

	if (startTime.isSet())
	{
		import.startTime = parseUnixTime(startTime.getValue());
		if (!import.startTime)
			throw UsageError(
				"--start-time " + startTime.getValue() + ": must be a Unix time in seconds");
	}
	import.recording = recording.getValue();
	import.rawlog = rawlog.getValue();
	import.cameraFile = camera.getValue();
	import.embed = embed.getValue();
	return true;
}

int run(int argc, char** argv)
{
	OniImport import;
	if (!parse(argc, argv, import)) return kSuccess;
	ProgressBar bar("converting");
	const auto report =
		importOni(import, [&](std::size_t frames, double share) { bar.update(frames, share); });
	bar.clear();
	std::printf(
		"%s: %zu frames in %.1f s from %s on, %zu colour and %zu depth images without partner\n",
		import.rawlog.c_str(), report.frames, report.duration,
		formatUnixTime(report.startTime).c_str(), report.unpairedColor, report.unpairedDepth);
	return kSuccess;
}

}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
