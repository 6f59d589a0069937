#include <semloop/config/Error.h>

#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "Application.h"
#include "AssociationCommand.h"
#include "LoopsCommand.h"
#include "ObjectsCommand.h"
#include "TrajectoryCommand.h"

namespace
{
struct Command
{
	std::string name;
	std::string summary;
	int (*run)(int argc, char** argv);
};

const std::vector<Command>& commands()
{
	static const std::vector<Command> all{
		{"trajectory", "absolute and relative error of a trajectory", semloop::trajectoryCommand},
		{"association", "which object the detections went into", semloop::associationCommand},
		{"loops", "true and false loop detections", semloop::loopsCommand},
		{"objects", "the objects, their places and surfaces", semloop::objectsCommand}};
	return all;
}

void printHelp(std::ostream& out)
{
	out << "usage: semloop-eval COMMAND [arguments]\n\n"
		   "Measures results of semloop against the truth.\n\n";
	for (const auto& command : commands())
		out << "  " << std::left << std::setw(14) << command.name << command.summary << "\n";
	out << "\nsemloop-eval COMMAND --help explains a command's arguments.\n";
}

std::string commandNames()
{
	std::string names;
	for (const auto& command : commands()) names += (names.empty() ? "" : ", ") + command.name;
	return names;
}

int run(int argc, char** argv)
{
	if (argc < 2)
		throw semloop::UsageError("no command given; use " + commandNames() + ", or --help");
	const std::string name = argv[1];
	if (name == "-h" || name == "--help")
	{
		printHelp(std::cout);
		return semloop::kSuccess;
	}
	for (const auto& command : commands())
	{
		if (command.name != name) continue;
		// The command parses what follows its own name, and calls itself by both in its help.
		std::string title = "semloop-eval " + name;
		std::vector<char*> arguments(argv + 1, argv + argc);
		arguments[0] = title.data();
		return command.run(int(arguments.size()), arguments.data());
	}
	throw semloop::UsageError("'" + name + "': no such command; use " + commandNames());
}
}  // namespace

int main(int argc, char** argv)
{
	return semloop::runApplication("semloop-eval", [&] { return run(argc, argv); });
}
