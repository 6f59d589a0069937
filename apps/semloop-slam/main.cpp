#include <malloc.h>
#include <semloop/config/Error.h>
#include <semloop/slam/Configuration.h>

#include <iostream>
#include <string>
#include <vector>

#include "Application.h"
#include "SlamRun.h"

namespace
{
/** The arguments, with the section that --live stands for when none follows. */
std::vector<char*> withSensorSection(int argc, char** argv)
{
	static char section[] = "sensor";
	std::vector<char*> words;
	for (int i = 0; i < argc; ++i)
	{
		words.push_back(argv[i]);
		const bool isLast = i + 1 == argc || argv[i + 1][0] == '-';
		if (std::string(argv[i]) == "--live" && isLast) words.push_back(section);
	}
	return words;
}

/** glibc soon takes also the images of frames from its heap, between objects that stay, and the holes that
 *  they leave are filled badly: a third of the resident memory after a minute. */
void keepImagesOutOfTheHeap()
{
#ifdef __GLIBC__
	mallopt(M_MMAP_THRESHOLD, 400'000);
#endif
}
}  // namespace

int main(int argc, char** argv)
{
	return semloop::runApplication(
		"semloop-slam",
		[&]() -> int
		{
			TCLAP::CmdLine command(
				"Object-level RGB-D SLAM with semantic loop closure. Maps a rawlog with RGB-D "
				"frames, or what a sensor sees; writes trajectory, objects, loops and maps.",
				' ', SEMLOOP_VERSION);
			TCLAP::ValueArg<std::string> config(
				"c", "config", "configuration, see config_ini/", false, "", "CONFIG.ini", command);
			TCLAP::ValueArg<std::string> input(
				"i", "input", "rawlog with CObservation3DRangeScan", false, "", "IN.rawlog",
				command);
			TCLAP::ValueArg<std::string> live(
				"", "live",
				"grabs from the sensor that this section of the configuration describes; --live "
				"alone: [sensor]",
				false, "", "SECTION", command);
			TCLAP::ValueArg<std::string> record(
				"", "record", "keeps what the sensor of --live gives", false, "", "OUT.rawlog",
				command);
			TCLAP::ValueArg<std::string> output(
				"o", "output", "folder for the results", false, "", "OUT/", command);
			TCLAP::ValueArg<std::string> instances(
				"", "instances",
				"recorded instances; default: IN_instances.rawlog when it is there", false, "",
				"X_instances.rawlog", command);
			TCLAP::MultiArg<std::string> set(
				"s", "set", "overrides one key of the configuration", false, "section.key=value",
				command);
			TCLAP::SwitchArg gui(
				"", "gui", "a window with the camera's picture, the map and the last loop",
				command);
			TCLAP::ValueArg<long> maxFrames(
				"", "max-frames", "stops after so many frames; 0: all", false, 0, "N", command);
			TCLAP::SwitchArg helpConfig(
				"", "help-config", "prints the reference of all configuration keys", command);
			auto words = withSensorSection(argc, argv);
			if (!semloop::parseArguments(command, int(words.size()), words.data()))
				return semloop::kSuccess;
			if (helpConfig.getValue())
			{
				std::cout << semloop::configurationReference();
				return semloop::kSuccess;
			}
			if (maxFrames.getValue() < 0)
				throw semloop::UsageError("--max-frames must be at least 0 (0: all)");
			keepImagesOutOfTheHeap();
			semloop::SlamRunArguments arguments;
			arguments.config = config.getValue();
			arguments.rawlog = input.getValue();
			arguments.sensor = live.getValue();
			arguments.record = record.getValue();
			arguments.output = output.getValue();
			arguments.instances = instances.getValue();
			arguments.window = gui.getValue();
			arguments.overrides = set.getValue();
			arguments.maxFrames = std::size_t(maxFrames.getValue());
			return semloop::runSlam(arguments);
		});
}
