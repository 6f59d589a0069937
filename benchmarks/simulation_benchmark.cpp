#include <benchmark/benchmark.h>
#include <mrpt/config/CConfigFile.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/ColorSensor.h>
#include <semloop/simulation/DepthSensor.h>
#include <semloop/simulation/SceneBuilder.h>
#include <semloop/simulation/SceneRenderer.h>
#include <semloop/simulation/SimulatedDetector.h>

#include <filesystem>
#include <memory>

// config_ini/scenes/apartment.ini, seed 1, 640 x 480 pixels: every tenth second of the way.
namespace
{
using namespace semloop;

struct Apartment
{
	Apartment()
	{
		const mrpt::config::CConfigFile config(SEMLOOP_SOURCE_DIR
											   "/config_ini/scenes/apartment.ini");
		const auto description = SceneDescription::load(
			config, {"depth_sensor", "color_sensor", "detector", "odometry"});
		built = std::make_unique<BuiltScene>(buildScene(description, FurnitureCatalog::open(), 1));
		camera = cameraOf(description.camera);
		way = carriedCamera(built->way, description.path, 0.1, mrpt::Clock::fromDouble(0), 1);
		renderer = std::make_unique<SceneRenderer>(built->scene);
	}
	RenderedView view(std::size_t i, bool color) const
	{
		return renderer->render(camera, way[i % way.size()].pose, color);
	}

	std::unique_ptr<BuiltScene> built;
	mrpt::img::TCamera camera;
	Trajectory way;
	std::unique_ptr<SceneRenderer> renderer;
};

/** Null, and the benchmark is skipped, without the furniture. */
const Apartment* apartment(benchmark::State& state)
{
	if (!std::filesystem::exists(FurnitureCatalog::kDefaultFolder))
	{
		state.SkipWithError("sweethome3d-furniture is not installed");
		return nullptr;
	}
	static const Apartment scene;
	return &scene;
}

/** What rawlog-simulate does with a frame, but for the files. */
void frame(benchmark::State& state, bool color)
{
	const auto* scene = apartment(state);
	if (!scene) return;
	const SimulatedDetectorOptions detector;
	std::size_t i = 0;
	for (auto _ : state)
	{
		const auto view = scene->view(i, color);
		benchmark::DoNotOptimize(senseDepth(view, {}, i));
		if (color) benchmark::DoNotOptimize(senseColor(view, {}, 0, i));
		benchmark::DoNotOptimize(trueInstances(view, scene->built->scene, detector, i));
		benchmark::DoNotOptimize(detectInstances(
			view, scene->renderer->hiddenShares(view), scene->built->scene, detector, i));
		++i;
	}
	state.SetItemsProcessed(int64_t(i));
}
BENCHMARK_CAPTURE(frame, with_color, true)->Unit(benchmark::kMillisecond)->MinTime(3);
BENCHMARK_CAPTURE(frame, without_color, false)->Unit(benchmark::kMillisecond)->MinTime(3);

void render(benchmark::State& state, bool color)
{
	const auto* scene = apartment(state);
	if (!scene) return;
	std::size_t i = 0;
	for (auto _ : state) benchmark::DoNotOptimize(scene->view(i++, color));
}
BENCHMARK_CAPTURE(render, with_color, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render, without_color, false)->Unit(benchmark::kMillisecond);

void hiddenShares(benchmark::State& state)
{
	const auto* scene = apartment(state);
	if (!scene) return;
	std::size_t i = 0;
	for (auto _ : state)
	{
		state.PauseTiming();
		const auto view = scene->view(i++, false);
		state.ResumeTiming();
		benchmark::DoNotOptimize(scene->renderer->hiddenShares(view));
	}
}
BENCHMARK(hiddenShares)->Unit(benchmark::kMillisecond)->Iterations(40);

}  // namespace

BENCHMARK_MAIN();
