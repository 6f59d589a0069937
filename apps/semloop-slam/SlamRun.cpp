#include "SlamRun.h"

#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/OtherMaps.h>
#include <semloop/slam/RunResults.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>

#include "Application.h"
#include "LiveInput.h"
#include "MappingLoop.h"
#include "ProgressBar.h"
#include "RunConfiguration.h"
#include "SlamWindow.h"
#include "StopSignal.h"

namespace semloop
{
namespace
{
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
	if (file.empty() && arguments.rawlog.empty()) return;
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

void printSummary(const SlamRunArguments& arguments, const SemanticSlam& slam, const RunInfo& info)
{
	std::printf(
		"%zu frames (%zu skipped, %zu lost) in %.1f s, %zu objects, %zu loops closed: %s\n",
		slam.frameCount(), info.skippedFrames, slam.lostFrameCount(), info.wallSeconds,
		slam.map().objects().size(), countLoops(slam.loops(), LoopVerdict::Decision::Accepted),
		arguments.output.c_str());
}

void printWarning(const std::string& warning)
{
	std::cerr << "semloop-slam: warning: " << warning << "\n";
}

/** Writes the results and tells how it ended; the exit code. A sensor without any frame
 *  leaves those of an earlier run alone. */
int conclude(
	const SlamRunArguments& arguments, const SemanticSlam& slam, const RunInfo& info,
	std::string failure, const std::function<void()>& writeResults)
{
	const bool stopped = info.endedBy == kEndedByUser;
	const bool hasFrames = slam.frameCount() > 0, hasResults = hasFrames || !info.live;
	std::string where;
	try
	{
		if (hasResults) writeResults();
		if (hasResults) where = "; results so far are in " + arguments.output;
	}
	catch (const std::exception& e)
	{
		failure += (failure.empty() ? "" : "; and ") + exceptionMessage(e);
	}
	if (failure.empty() && hasFrames && slam.segmentedFrameCount() == 0)
		printWarning(
			"no frame has instances, so there are no objects and no loops; " +
			std::string(
				info.live ? "did the network see nothing, or have no time?"
						  : "were they made from this rawlog?"));
	if (stopped) std::cerr << "semloop-slam: stopped by Ctrl-C" << where << "\n";
	if (failure.empty() && !hasFrames && (!stopped || info.skippedFrames > 0))
		failure = info.rawlog +
				  ": no usable RGB-D frame (CObservation3DRangeScan with colour and depth) in it";
	if (failure.empty()) return kSuccess;
	std::cerr << "semloop-slam: " << failure << where << "\n";
	return kFailed;
}

/** A recording cannot be made again. */
void requireNewRawlog(const std::string& path)
{
	if (std::filesystem::path(path).extension() != ".rawlog")
		throw UsageError("--record " + path + ": give a name that ends in .rawlog");
	for (const std::string& file : {path, RawlogWriter::partialPath(path)})
		if (std::filesystem::exists(file))
			throw UsageError(
				"--record: " + file + " is there already; remove it or choose another name");
}

void requireArguments(const SlamRunArguments& arguments)
{
	requireArgument(arguments.config, "-c", "the configuration");
	const bool isLive = !arguments.sensor.empty();
	if (isLive && !arguments.rawlog.empty())
		throw UsageError("-i and --live exclude each other: a run maps a rawlog or a sensor");
	if (!isLive) requireArgument(arguments.rawlog, "-i", "the rawlog, or --live for a sensor");
	if (!isLive && !arguments.record.empty())
		throw UsageError("--record needs --live: it keeps what a sensor gives");
	if (!arguments.record.empty()) requireNewRawlog(arguments.record);
	requireArgument(arguments.output, "-o", "the folder for the results");
	requireFile(arguments.config, "config_ini/ has examples");
	if (!isLive) requireFile(arguments.rawlog, "make one with tum2rawlog or rawlog-grabber");
	requireWritableFolder(arguments.output);
}
}  // namespace

int runSlam(const SlamRunArguments& arguments)
{
	requireArguments(arguments);
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
	std::unique_ptr<SlamWindow> window;
	if (arguments.window) window = std::make_unique<SlamWindow>("semloop-slam");
	MappingLoop loop(slam, timings, info, bar, window.get(), arguments.maxFrames);
	std::unique_ptr<LiveInput> live;
	std::string failure;
	if (arguments.sensor.empty())
	{
		FrameSource source(
			std::make_unique<RawlogReader>(arguments.rawlog), frontEnd, slam.options().framesAhead,
			timings);
		failure = loop.run(source);
	}
	else
	{
		live = std::make_unique<LiveInput>(config, arguments.sensor, arguments.record);
		info.rawlog = live->sensor().name();
		info.endedBy = "end of the recording";
		failure = live->run(loop, frontEnd, slam, timings, info);
	}
	bar.clear();
	slam.finish();
	if (window) window->show(slam, timings, {});
	info.wallSeconds =
		std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
	const int code = conclude(
		arguments, slam, info, failure,
		[&]
		{
			writeRunResults(arguments.output, slam, info, timings);
			writeOtherMaps(arguments.output + "/maps", otherMaps.names(), *otherMaps.build(slam));
			printSummary(arguments, slam, info);
		});
	if ((live && live->isStuck()) || (window && window->isLost())) leaveAtOnce(code);
	return code;
}

}  // namespace semloop
