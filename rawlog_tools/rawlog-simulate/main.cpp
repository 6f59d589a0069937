#include <mrpt/core/WorkerThreadsPool.h>
#include <semloop/config/Error.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <future>
#include <limits>
#include <thread>

#include "Application.h"
#include "ProgressBar.h"
#include "RunConfiguration.h"
#include "SimulationFiles.h"
#include "StopSignal.h"

namespace
{
using namespace semloop;

const char* const kName = "rawlog-simulate";

struct Arguments
{
	std::string scene, rawlog;
	uint64_t seed = 1;
	std::size_t frames = 0;  //!< 0: all
	std::string size;
	std::vector<std::string> overrides;
	bool color = true, embed = false;
	unsigned threads = 1;
	std::string furniture = FurnitureCatalog::kDefaultFolder;
};

constexpr int64_t kMost = std::numeric_limits<int64_t>::max();

int64_t within(TCLAP::ValueArg<int64_t>& argument, int64_t least, int64_t most)
{
	const int64_t value = argument.getValue();
	if (value >= least && value <= most) return value;
	const std::string limits = most == kMost
								   ? "at least " + std::to_string(least)
								   : std::to_string(least) + " to " + std::to_string(most);
	throw UsageError(
		"--" + argument.getName() + " " + std::to_string(value) + ": not allowed; use " + limits);
}

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, Arguments& out)
{
	TCLAP::CmdLine line(
		"Renders a furnished room as an RGB-D camera would see it, with the truth.", ' ',
		SEMLOOP_VERSION);
	using Text = TCLAP::ValueArg<std::string>;
	using Number = TCLAP::ValueArg<int64_t>;  // unsigned ones would take -1 for a large one
	TCLAP::UnlabeledValueArg<std::string> scene(
		"scene", "Scene to simulate, e.g. config_ini/scenes/apartment.ini.", true, "", "SCENE.ini",
		line);
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog", "Rawlog to write; everything else is named after it.", true, "", "OUT.rawlog",
		line);
	Text furniture(
		"", "furniture", "Folder of Sweet Home 3D's catalogues.", false, out.furniture, "DIR",
		line);
	Number threads(
		"", "threads", "Threads; the result does not depend on them. All cores unless given.",
		false, std::max(1U, std::thread::hardware_concurrency()), "N", line);
	TCLAP::SwitchArg embed("", "embed", "Images inside the rawlog.", line);
	TCLAP::SwitchArg noColor("", "no-color", "Black colour images: several times as fast.", line);
	TCLAP::MultiArg<std::string> set(
		"s", "set", "Overrides one key of the scene.", false, "section.key=value", line);
	Text size("", "size", "Size of the images instead of the scene's.", false, "", "WxH", line);
	Number frames("", "frames", "Only the first N frames.", false, 0, "N", line);
	Number seed(
		"", "seed", "Chooses furniture, places and noise; 1 unless given.", false, 1, "N", line);
	if (!parseArguments(line, argc, argv)) return false;

	out.scene = scene.getValue();
	out.rawlog = rawlog.getValue();
	out.furniture = furniture.getValue();
	out.threads = unsigned(within(threads, 1, 256));
	out.embed = embed.getValue();
	out.color = !noColor.getValue();
	out.overrides = set.getValue();
	out.size = size.getValue();
	out.frames = std::size_t(frames.isSet() ? within(frames, 1, kMost) : 0);
	out.seed = uint64_t(within(seed, 0, Simulator::kMostSeed));
	return true;
}

void applySize(RunConfiguration& config, const std::string& size)
{
	if (size.empty()) return;
	int width = 0, height = 0;
	char rest = 0;
	if (std::sscanf(size.c_str(), "%dx%d%c", &width, &height, &rest) != 2)
		throw UsageError("--size " + size + ": write WIDTHxHEIGHT, e.g. 320x240");
	config.apply(
		{"camera.width=" + std::to_string(width), "camera.height=" + std::to_string(height)});
}

/** Waits for all that have begun: the pool would abort them, and say so. */
struct FramesAhead : std::deque<std::future<SimulatedFrame>>
{
	~FramesAhead()
	{
		for (auto& frame : *this)
			if (frame.valid()) frame.wait();
	}
};

/** Renders in all threads, a few frames ahead, and writes in order. */
std::size_t writeFrames(
	const Simulator& simulator, const Arguments& arguments, SimulationFiles& files)
{
	const std::size_t all = simulator.trajectory().size();
	const std::size_t count = arguments.frames == 0 ? all : std::min(all, arguments.frames);
	mrpt::WorkerThreadsPool pool(arguments.threads);
	FramesAhead ahead;
	std::size_t begun = 0, written = 0;
	ProgressBar bar("simulating");
	while (written < count && !stopRequested())
	{
		for (; begun < count && ahead.size() < 2 * arguments.threads; ++begun)
			ahead.push_back(pool.enqueue(
				[&simulator, &arguments](std::size_t i)
				{ return simulator.frame(i, arguments.color); },
				begun));
		SimulatedFrame frame = ahead.front().get();
		ahead.pop_front();
		files.write(frame);
		++written;
		bar.update(written, double(written) / double(count));
	}
	bar.clear();
	return written;
}

int run(int argc, char** argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments)) return kSuccess;
	requireFile(arguments.scene, "config_ini/scenes has some scenes");
	RunConfiguration config(arguments.scene);
	config.apply(arguments.overrides);
	applySize(config, arguments.size);
	const auto catalog = FurnitureCatalog::open(arguments.furniture);
	const Simulator simulator(config, catalog, arguments.seed);
	catchStopSignal();
	SimulationFiles files(arguments.rawlog, arguments.embed);
	const std::size_t frames = writeFrames(simulator, arguments, files);
	files.close(simulator, catalog);
	std::printf(
		"%s: %zu frames of %ux%u pixels, %zu objects\n", arguments.rawlog.c_str(), frames,
		simulator.camera().ncols, simulator.camera().nrows, simulator.scene().objects.size());
	return kSuccess;
}

}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
