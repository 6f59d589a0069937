#include <semloop/config/Error.h>
#include <semloop/slam/Configuration.h>

#include <iostream>

#include "Application.h"
#include "SlamRun.h"

int main(int argc, char** argv)
{
	return semloop::runApplication(
		"semloop-slam",
		[&]() -> int
		{
			TCLAP::CmdLine command(
				"Object-level RGB-D SLAM with semantic loop closure. Reads a rawlog with RGB-D "
				"frames, "
				"writes trajectory, objects, loops and maps.",
				' ', SEMLOOP_VERSION);
			TCLAP::ValueArg<std::string> config(
				"c", "config", "configuration, see config_ini/", false, "", "CONFIG.ini", command);
			TCLAP::ValueArg<std::string> input(
				"i", "input", "rawlog with CObservation3DRangeScan", false, "", "IN.rawlog",
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
			TCLAP::ValueArg<long> maxFrames(
				"", "max-frames", "stops after so many frames; 0: all", false, 0, "N", command);
			TCLAP::SwitchArg helpConfig(
				"", "help-config", "prints the reference of all configuration keys", command);
			if (!semloop::parseArguments(command, argc, argv)) return semloop::kSuccess;
			if (helpConfig.getValue())
			{
				std::cout << semloop::configurationReference();
				return semloop::kSuccess;
			}
			if (maxFrames.getValue() < 0)
				throw semloop::UsageError("--max-frames must be at least 0 (0: all)");
			semloop::SlamRunArguments arguments;
			arguments.config = config.getValue();
			arguments.rawlog = input.getValue();
			arguments.output = output.getValue();
			arguments.instances = instances.getValue();
			arguments.overrides = set.getValue();
			arguments.maxFrames = std::size_t(maxFrames.getValue());
			return semloop::runSlam(arguments);
		});
}
