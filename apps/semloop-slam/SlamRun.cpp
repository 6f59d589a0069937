#include "SlamRun.h"

#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/OtherMaps.h>
#include <semloop/slam/RunResults.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "Application.h"
#include "ProgressBar.h"
#include "RunConfiguration.h"
#include "StopSignal.h"

namespace semloop
{
namespace
{
const char* const kCtrlC = "Ctrl-C";

/** Warnings and news on stderr, one line each, without tearing the progress bar. */
class ConsoleLogger : public mrpt::system::COutputLogger
{
public:
	explicit ConsoleLogger(ProgressBar& bar) : COutputLogger("semloop-slam")
	{
		logging_enable_console_output = false;
		logRegisterCallback(
			[&bar](
				std::string_view text, const mrpt::system::VerbosityLevel, std::string_view,
				const mrpt::Clock::time_point)
			{
				bar.clear();
				std::cerr << "semloop-slam: " << text
						  << (text.empty() || text.back() != '\n' ? "\n" : "");
			});
	}
};

void requireArgument(const std::string& value, const char* flag, const char* what)
{
	if (value.empty())
		throw UsageError(std::string(flag) + " is missing: " + what + "; see semloop-slam --help");
}

void useRecordedInstances(mrpt::config::CConfigFileBase& config, const SlamRunArguments& arguments)
{
	std::string file = arguments.instances;
	if (file.empty() && config.keyExists("segmentation", "file")) return;
	if (file.empty()) file = instancesSidecarPath(arguments.rawlog);
	ModuleNames names;
	names.loadFromConfigFile(config, "modules");
	const bool recorded = names.segmenter == "semloop::RecordedSegmenter";
	if (!arguments.instances.empty() && !recorded)
		throw UsageError(
			"--instances needs semloop::RecordedSegmenter, but " + configFileName(config) +
			": [modules] segmenter = " + names.segmenter);
	if (recorded) config.write("segmentation", "file", file);
}

struct Progress
{
	SemanticSlam& slam;
	RunInfo& info;
	ProgressBar& bar;
};

void report(const std::vector<std::string>& warnings, Progress& progress)
{
	for (const auto& warning : warnings)
	{
		progress.bar.clear();
		std::cerr << "semloop-slam: warning: " << warning << "\n";
		progress.info.skippedFrames.push_back(warning);
	}
}

/** The next frame, and the warnings about those that were skipped before it or before the end. */
std::optional<SlamFrame> nextFrame(FrameSource& source, Progress& progress)
{
	try
	{
		auto frame = source.next();
		report(frame ? frame->skipped : source.skippedAtEnd(), progress);
		return frame;
	}
	catch (const std::exception&)
	{
		report(source.skippedAtEnd(), progress);
		throw;
	}
}

/** What ended the run early because of bad input; empty otherwise. */
std::string processAll(FrameSource& source, std::size_t maxFrames, Progress progress)
{
	while (!stopRequested())
	{
		if (maxFrames > 0 && progress.slam.frameCount() >= maxFrames)
		{
			progress.info.endedBy = "--max-frames";
			return {};
		}
		try
		{
			const auto frame = nextFrame(source, progress);
			if (!frame) return {};
			progress.slam.process(*frame);
			progress.bar.update(progress.slam.frameCount(), frame->progress);
		}
		catch (const std::exception& e)
		{
			return progress.info.endedBy = exceptionMessage(e);
		}
	}
	progress.info.endedBy = kCtrlC;
	return {};
}

void printSummary(const SlamRunArguments& arguments, const SemanticSlam& slam, const RunInfo& info)
{
	std::size_t accepted = 0;
	for (const auto& record : slam.loops())
		accepted += record.verdict.decision == LoopVerdict::Decision::Accepted;
	std::printf(
		"%zu frames (%zu skipped, %zu lost) in %.1f s, %zu objects, %zu loops closed: %s\n",
		slam.frameCount(), info.skippedFrames.size(), slam.lostFrameCount(), info.wallSeconds,
		slam.map().objects().size(), accepted, arguments.output.c_str());
}
}  // namespace

int runSlam(const SlamRunArguments& arguments)
{
	requireArgument(arguments.config, "-c", "the configuration");
	requireArgument(arguments.rawlog, "-i", "the rawlog");
	requireArgument(arguments.output, "-o", "the folder for the results");
	requireFile(arguments.config, "config_ini/ has examples");
	requireFile(arguments.rawlog, "make one with tum2rawlog or rawlog-grabber");
	requireWritableFolder(arguments.output);

	RunConfiguration config(arguments.config);
	config.apply(arguments.overrides);
	useRecordedInstances(config, arguments);

	const auto start = std::chrono::steady_clock::now();
	ProgressBar bar("mapping");
	ConsoleLogger logger(bar);
	StageTimings timings;
	FrontEnd frontEnd = makeFrontEnd(config);
	const OtherMaps otherMaps(config);
	SemanticSlam slam(config, logger, timings);
	RunInfo info;
	info.rawlog = arguments.rawlog;
	info.config = arguments.config;

	catchStopSignal();
	FrameSource source(
		arguments.rawlog, frontEnd.segmenter, frontEnd.embedder, slam.options().framesAhead,
		timings);
	std::string failure = processAll(source, arguments.maxFrames, {slam, info, bar});
	bar.clear();
	slam.finish();
	info.wallSeconds =
		std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	writeRunResults(arguments.output, slam, info, timings);
	writeOtherMaps(arguments.output + "/maps", otherMaps.names(), *otherMaps.build(slam));
	printSummary(arguments, slam, info);
	if (failure.empty() && slam.frameCount() > 0 && slam.segmentedFrameCount() == 0)
		std::cerr
			<< "semloop-slam: warning: no frame has instances, so there are no objects and no "
			   "loops; were they made from this rawlog?\n";
	if (info.endedBy == kCtrlC)
		std::cerr << "semloop-slam: stopped by Ctrl-C; results so far are in " << arguments.output
				  << "\n";
	if (failure.empty() && slam.frameCount() == 0 && !stopRequested())
		failure = arguments.rawlog +
				  ": no usable RGB-D frame (CObservation3DRangeScan with colour and depth) in it";
	if (failure.empty()) return kSuccess;
	std::cerr << "semloop-slam: " << failure << "; results so far are in " << arguments.output
			  << "\n";
	return kFailed;
}

}  // namespace semloop
