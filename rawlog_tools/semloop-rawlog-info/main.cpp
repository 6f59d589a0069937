#include <mrpt/system/datetime.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/observations/RawlogReader.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <vector>

#include "Application.h"
#include "Contents.h"
#include "ProgressBar.h"

namespace
{
using namespace semloop;
using Time = mrpt::Clock::time_point;

const char* const kName = "semloop-rawlog-info";
constexpr std::size_t kMostGaps = 5;

struct Arguments
{
	std::string rawlog;
	std::vector<std::string> plugins;
	bool images = false;
};

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, Arguments& arguments)
{
	TCLAP::CmdLine commandLine(
		"Tells what a rawlog holds: sensors, rates, gaps, images, instances. Ends with exit code 1 "
		"and says where when it is damaged or files are missing.",
		' ', SEMLOOP_VERSION);
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog", "Rawlog to read.", true, "", "FILE.rawlog", commandLine);
	TCLAP::SwitchArg images(
		"", "images", "Read every image, too, to find damaged ones.", commandLine);
	TCLAP::MultiArg<std::string> plugins(
		"p", "plugin", "Plug-in for another class in the rawlog.", false, "LIB.so", commandLine);
	if (!parseArguments(commandLine, argc, argv)) return false;
	arguments.rawlog = rawlog.getValue();
	arguments.images = images.getValue();
	arguments.plugins = plugins.getValue();
	return true;
}

double secondsBetween(Time a, Time b)
{
	return std::chrono::duration<double>(b - a).count();
}

/** Earliest and latest time of all; false when nothing has a time. */
bool timesOf(const Contents& contents, Time& first, Time& last)
{
	bool any = false;
	for (const auto& [key, stream] : contents.streams())
		for (const auto& time : stream.times)
		{
			first = any ? std::min(first, time) : time;
			last = any ? std::max(last, time) : time;
			any = true;
		}
	return any;
}

void printTimes(const Stream& stream, Time begin)
{
	const auto [first, last] = std::minmax_element(stream.times.begin(), stream.times.end());
	const double duration = secondsBetween(*first, *last);
	std::printf(
		"    %.3f s to %.3f s", secondsBetween(begin, *first), secondsBetween(begin, *last));
	if (duration > 0) std::printf(", %.2f a second", double(stream.times.size() - 1) / duration);
	std::printf("\n");
	if (stream.outOfOrder() > 0)
		std::printf("    %zu earlier than the one before\n", stream.outOfOrder());

	auto gaps = stream.gaps();
	if (gaps.empty()) return;
	std::stable_sort(
		gaps.begin(), gaps.end(),
		[](const auto& a, const auto& b) { return a.seconds > b.seconds; });
	if (gaps.size() == 1)
		std::printf("    1 gap:");
	else
		std::printf("    %zu gaps, the longest:", gaps.size());
	for (std::size_t i = 0; i < std::min(kMostGaps, gaps.size()); i++)
		std::printf(
			"%s %.3f s at %.3f s", i > 0 ? "," : "", gaps[i].seconds,
			secondsBetween(begin, gaps[i].begin));
	std::printf("\n");
}

void printInstances(const Stream& stream)
{
	std::vector<std::pair<std::string, std::size_t>> labels(
		stream.instancesOfLabel.begin(), stream.instancesOfLabel.end());
	std::stable_sort(
		labels.begin(), labels.end(),
		[](const auto& a, const auto& b) { return a.second > b.second; });
	for (const auto& [label, count] : labels) std::printf("    %8zu %s\n", count, label.c_str());
}

void print(const std::string& path, const Contents& contents)
{
	Time begin, end;
	std::printf("%s: %zu observations", path.c_str(), contents.observations());
	if (timesOf(contents, begin, end))
		std::printf(
			" in %.3f s from %s UTC", secondsBetween(begin, end),
			mrpt::system::dateTimeToString(begin).c_str());
	std::printf("\n");
	for (const auto& [key, stream] : contents.streams())
	{
		std::printf(
			"  %s: %zu %s\n", key.first.empty() ? "(no label)" : key.first.c_str(),
			stream.observations, key.second.c_str());
		if (stream.times.size() < stream.observations)
			std::printf("    %zu without a time\n", stream.observations - stream.times.size());
		if (!stream.times.empty()) printTimes(stream, begin);
		for (const auto& [form, times] : stream.forms)
		{
			std::printf("    %s", form.c_str());
			if (stream.forms.size() > 1) std::printf(": %zu", times);
			std::printf("\n");
		}
		printInstances(stream);
	}
	if (contents.firstInstances())
		std::printf(
			"  From observation %zu on MRPT's own programs need libsemloop-observations.so "
			"(rawlog-edit -p, RawLogViewer -l, else LD_PRELOAD): without it they stop there and "
			"say "
			"so on stderr only.\n",
			*contents.firstInstances());
}

/** Reads all; false, with a line on stderr, where something is damaged. */
bool read(const Arguments& arguments, Contents& contents)
{
	RawlogReader reader(arguments.rawlog);
	ProgressBar bar("reading");
	std::size_t damagedImages = 0;
	try
	{
		while (const auto observation = reader.next())
		{
			contents.add(*observation);
			bar.update(contents.observations(), reader.progress());
			if (!arguments.images) continue;
			try
			{
				Contents::checkImages(*observation);
			}
			catch (const InputError& e)
			{
				bar.clear();
				if (damagedImages++ == 0) std::cerr << kName << ": " << e.what() << "\n";
			}
		}
	}
	catch (const InputError& e)
	{
		bar.clear();
		std::cerr << kName << ": " << e.what() << "\n";
		return false;
	}
	if (damagedImages > 1)
		std::cerr << kName << ": " << arguments.rawlog << ": " << damagedImages
				  << " observations with images that cannot be used\n";
	return damagedImages == 0;
}

int run(int argc, char** argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments)) return kSuccess;
	loadPlugins(arguments.plugins, "--plugin");
	requireFile(arguments.rawlog, "correct the path");
	Contents contents;
	const bool whole = read(arguments, contents);
	print(arguments.rawlog, contents);
	const auto& missing = contents.missingFiles();
	if (!missing.empty())
		std::cerr << kName << ": " << missing.front() << ": is missing"
				  << (missing.size() > 1
						  ? ", and " + std::to_string(missing.size() - 1) + " other files"
						  : "")
				  << "; keep the folder of images beside the rawlog\n";
	return whole && missing.empty() ? kSuccess : kFailed;
}
}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
