#include <benchmark/benchmark.h>
#include <semloop/object_map/TsdfVolume.h>
#include <semloop/observations/CameraFrames.h>

#include <map>

#include "../tests/object_map/AnalyticScene.h"
#include "../tests/object_map/ObjectMapFixtures.h"

// A desk-like scene: two rows of spheres and boxes before a wall, mapped from seven views on an arc.
namespace
{
using namespace semloop;
using namespace semloop::testing;
using Eigen::Vector3d;

struct MappedObject
{
	Shape shape;
	Vector3d centre;
	TsdfVolume volume;
	InstanceMask mask;  //!< in the frame to be fused
};

struct Scene
{
	std::vector<MappedObject> objects;
	mrpt::poses::CPose3D T_world_camera;
	RgbdFrame frame;
	std::size_t coveredPixels = 0;
};

mrpt::poses::CPose3D fromCentre(const Vector3d& centre, const mrpt::poses::CPose3D& T_world_camera)
{
	return mrpt::poses::CPose3D(-centre.x(), -centre.y(), -centre.z(), 0, 0, 0) + T_world_camera;
}

View renderObject(const Scene& scene, std::size_t which, const mrpt::poses::CPose3D& T_world_camera)
{
	std::vector<Shape> shapes{scene.objects[which].shape};
	for (std::size_t i = 0; i < scene.objects.size(); ++i)
		if (i != which) shapes.push_back(scene.objects[i].shape);
	shapes.push_back(box({-3, 1, -3}, {3, 1.1, 3}));
	return render(shapes, T_world_camera);
}

Scene makeScene(int columns)
{
	Scene scene;
	for (int i = 0; i < 2 * columns; ++i)
	{
		const bool back = i >= columns;
		const double spacing = 1.5 / columns, size = 0.36 * spacing * (1 + 0.25 * (i % 3));
		const Vector3d centre(
			(i % columns - 0.5 * (columns - 1)) * spacing, back ? 0.3 : -0.1, back ? 0.25 : -0.2);
		const Vector3d half(size, 0.7 * size, 1.2 * size);
		TsdfOptions o;
		o.voxelSize = std::clamp(2.4 * size / 64, 0.005, 0.015);
		o.truncation = 4 * o.voxelSize;
		const Shape shape = i % 2 ? sphere(size, centre) : box(centre - half, centre + half);
		scene.objects.push_back({shape, centre, TsdfVolume(o), {}});
	}
	for (int view = -3; view <= 3; ++view)
	{
		const auto pose = lookAt({0.3 * view, -1.4, 0.3});
		for (std::size_t i = 0; i < scene.objects.size(); ++i)
		{
			const View seen = renderObject(scene, i, pose);
			auto& object = scene.objects[i];
			object.volume.integrate(seen.frame, seen.mask, fromCentre(object.centre, pose));
		}
	}
	scene.T_world_camera = lookAt({0.15, -1.4, 0.3});
	for (std::size_t i = 0; i < scene.objects.size(); ++i)
	{
		const View seen = renderObject(scene, i, scene.T_world_camera);
		scene.frame = seen.frame;
		scene.objects[i].mask = seen.mask;
		scene.coveredPixels += seen.mask.area();
	}
	return scene;
}

/** Rendered once, not at every round of the benchmark's calibration. */
const Scene& sceneOf(std::int64_t objects)
{
	static std::map<std::int64_t, Scene> scenes;
	const auto known = scenes.find(objects);
	if (known != scenes.end()) return known->second;
	return scenes.emplace(objects, makeScene(static_cast<int>(objects) / 2)).first->second;
}

void report(benchmark::State& state, const Scene& scene)
{
	double bytes = 0, blocks = 0, voxelSize = 0;
	for (const auto& object : scene.objects)
	{
		bytes += static_cast<double>(object.volume.memoryBytes());
		blocks += static_cast<double>(object.volume.blockCount());
		voxelSize += object.volume.options().voxelSize;
	}
	const auto n = static_cast<double>(scene.objects.size());
	state.counters["objects"] = n;
	state.counters["coverage"] = static_cast<double>(scene.coveredPixels) / (640 * 480);
	state.counters["blocks"] = blocks / n;
	state.counters["MB_per_object"] = bytes / n / 1e6;
	state.counters["voxel_mm"] = 1e3 * voxelSize / n;
}

void integrateObjects(benchmark::State& state)
{
	Scene scene = sceneOf(state.range(0));
	for (auto _ : state)
		for (auto& object : scene.objects)
			object.volume.integrate(
				scene.frame, object.mask, fromCentre(object.centre, scene.T_world_camera));
	report(state, scene);
}
BENCHMARK(integrateObjects)->Arg(10)->Unit(benchmark::kMillisecond);

void raycastObjects(benchmark::State& state)
{
	const Scene& scene = sceneOf(state.range(0));
	for (auto _ : state)
		for (const auto& object : scene.objects)
			benchmark::DoNotOptimize(object.volume.raycast(
				scene.frame.camera, -fromCentre(object.centre, scene.T_world_camera)));
	report(state, scene);
}
BENCHMARK(raycastObjects)->Arg(20)->Arg(10)->Unit(benchmark::kMillisecond);

void readObject(benchmark::State& state, const std::function<void(const TsdfVolume&)>& read)
{
	const Scene& scene = sceneOf(10);
	for (auto _ : state) read(scene.objects[0].volume);
	state.counters["blocks"] = static_cast<double>(scene.objects[0].volume.blockCount());
	state.counters["points"] = static_cast<double>(scene.objects[0].volume.surface().size());
}
BENCHMARK_CAPTURE(
	readObject, surface, [](const TsdfVolume& v) { benchmark::DoNotOptimize(v.surface()); })
	->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(readObject, mesh, [](const TsdfVolume& v) { benchmark::DoNotOptimize(v.mesh()); })
	->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(
	readObject, boundingBox, [](const TsdfVolume& v) { benchmark::DoNotOptimize(v.boundingBox()); })
	->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(
	readObject, mergeCopy,
	[](const TsdfVolume& v)
	{
		TsdfVolume copy = v;
		copy.merge(v, mrpt::poses::CPose3D(0.01, 0, 0, 0.1, 0, 0));
	})
	->Unit(benchmark::kMillisecond);

/** What a particle filter does: one observation of the ten balls in view, a thousand poses, thirty objects
 *  in the map. */
void likelihoodOfThousandPoses(benchmark::State& state)
{
	using namespace semloop::synthetic;
	synthetic::Scene balls;
	const std::vector<uint32_t> labels(30, kCup);
	for (int i = 0; i < 30; ++i)
	{
		const double angle = 2 * M_PI * i / 30, radius = 0.5 + 0.25 * (i % 3);
		const TPoint3D centre(radius * std::cos(angle), radius * std::sin(angle), 0.85);
		balls.spheres.push_back({centre, 0.04, {40, 40, 220}, i + 1, 0});
	}
	const auto seenFrom = [&](int place) {
		return observationOf(
			renderView(balls, testCamera(), onCircle(place, 8)), labels, CPose3D());
	};
	CObjectMap map;
	for (int place = 0; place < 8; ++place)
		map.insertObservation(seenFrom(place), onCircle(place, 8) + (-robotFromCamera(CPose3D())));
	auto observation = seenFrom(1);
	observation.instances.resize(std::min<std::size_t>(10, observation.instances.size()));
	for (auto _ : state)
		for (int i = 0; i < 1000; ++i)
			benchmark::DoNotOptimize(
				map.computeObservationLikelihood(observation, CPose3D(0.001 * i, 0, 1, 0, 0, 0)));
	state.counters["objects"] = static_cast<double>(map.objects().size());
	state.counters["detections"] = static_cast<double>(observation.instances.size());
}
BENCHMARK(likelihoodOfThousandPoses)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
