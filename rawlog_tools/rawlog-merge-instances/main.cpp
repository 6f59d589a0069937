#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <vector>

#include "Application.h"
#include "Merge.h"
#include "ProgressBar.h"

namespace
{
using namespace semloop;

const char* const kName = "rawlog-merge-instances";

struct Arguments
{
	MergeFiles files;
	std::vector<std::string> plugins;
	bool split = false;
	bool leaveOut = false;
	bool force = false;

	const std::string& input() const { return split ? files.merged : files.rawlog; }
	const std::string& output() const { return split ? files.rawlog : files.merged; }
};

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, Arguments& arguments)
{
	TCLAP::CmdLine commandLine(
		"Puts the instances of a sidecar (IN_instances.rawlog) into the rawlog, each right behind "
		"the range scan of its time, or takes them out again. Programs that have not loaded "
		"libsemloop-observations.so stop reading a merged rawlog at the first instances.",
		' ', SEMLOOP_VERSION);
	using Text = TCLAP::ValueArg<std::string>;
	TCLAP::UnlabeledValueArg<std::string> in(
		"in", "Rawlog to read.", true, "", "IN.rawlog", commandLine);
	TCLAP::UnlabeledValueArg<std::string> out(
		"out", "Rawlog to write.", true, "", "OUT.rawlog", commandLine);
	TCLAP::SwitchArg force("", "force", "Replace files that are there.", commandLine);
	TCLAP::SwitchArg leaveOut(
		"", "leave-out", "Leave out instances without a range scan of their time.", commandLine);
	TCLAP::SwitchArg split(
		"", "split", "Take the instances out: writes OUT.rawlog and its sidecar.", commandLine);
	TCLAP::MultiArg<std::string> plugins(
		"p", "plugin", "Plug-in for another class in the rawlog.", false, "LIB.so", commandLine);
	Text instances(
		"", "instances", "The sidecar; without, <rawlog>_instances.rawlog.", false, "", "X.rawlog",
		commandLine);
	if (!parseArguments(commandLine, argc, argv)) return false;

	arguments.split = split.getValue();
	arguments.leaveOut = leaveOut.getValue();
	arguments.force = force.getValue();
	arguments.plugins = plugins.getValue();
	auto& files = arguments.files;
	files.rawlog = arguments.split ? out.getValue() : in.getValue();
	files.merged = arguments.split ? in.getValue() : out.getValue();
	files.instances = instances.isSet() ? instances.getValue() : instancesSidecarPath(files.rawlog);
	return true;
}

/** Also of files that are not there yet. */
bool isSameFile(const std::string& a, const std::string& b)
{
	std::error_code error;
	if (std::filesystem::equivalent(a, b, error)) return true;
	const auto full = [](const std::string& path)
	{ return std::filesystem::weakly_canonical(std::filesystem::absolute(path)); };
	return full(a) == full(b);
}

/** Neither there nor half there: rawlog-segment goes on from what is in such a file. */
void requireFree(const std::string& output, bool force)
{
	for (const auto& path : {output, RawlogWriter::partialPath(output)})
		if (!force && std::filesystem::exists(path))
			throw InputError(path + ": is there already; name another or add --force");
}

void requireUsableFiles(const Arguments& arguments)
{
	const auto& files = arguments.files;
	requireFile(arguments.input(), "correct the path");
	for (const auto* const path : {&files.rawlog, &files.merged})
		if (isSameFile(*path, files.instances))
			throw UsageError(files.instances + ": cannot be rawlog and sidecar at once");
	if (isSameFile(files.rawlog, files.merged))
		throw UsageError(files.merged + ": cannot be read and written at once");
	requireFree(arguments.output(), arguments.force);
	if (arguments.split)
		requireFree(files.instances, arguments.force);
	else
		requireFile(files.instances, "rawlog-segment makes it, --instances names another");
	requireFreeImagesFolder(arguments.input(), arguments.output(), arguments.force);
}

/** Leaves nothing half written behind when the input is refused. */
MergeReport mergeOrSplit(const Arguments& arguments)
{
	const auto& files = arguments.files;
	ProgressBar bar(arguments.split ? "splitting" : "merging");
	const auto progress = [&](std::size_t objects, double share) { bar.update(objects, share); };
	try
	{
		return arguments.split ? splitInstances(files, progress)
							   : mergeInstances(files, arguments.leaveOut, progress);
	}
	catch (const InputError&)
	{
		std::error_code ignored;
		std::filesystem::remove(RawlogWriter::partialPath(arguments.output()), ignored);
		if (arguments.split)
			std::filesystem::remove(RawlogWriter::partialPath(files.instances), ignored);
		throw;
	}
}

int run(int argc, char** argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments)) return kSuccess;
	loadPlugins(arguments.plugins, "--plugin");
	requireUsableFiles(arguments);
	const auto& files = arguments.files;
	const auto report = mergeOrSplit(arguments);
	linkExternalImages(arguments.input(), arguments.output());
	std::printf(
		"%s: %zu objects%s %zu observations of instances%s", arguments.output().c_str(),
		report.objects, arguments.split ? " without" : " and", report.instances,
		arguments.split ? (", which are in " + files.instances).c_str() : "");
	if (report.left > 0) std::printf("; %zu without a scan of their time left out", report.left);
	std::printf("\n");
	if (report.damage.empty()) return kSuccess;
	std::cerr << kName << ": " << report.damage << "\n";
	return kFailed;
}
}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
