#include <semloop/config/Error.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/Furnishing.h>
#include <semloop/simulation/SceneBuilder.h>

#include <cmath>
#include <filesystem>
#include <set>

namespace semloop
{
namespace
{
constexpr double kCarrierRadius = 0.2;  // [m]
constexpr double kLampDrop = 0.25;      // of a lamp below the ceiling [m]

LabelSet labelsOf(const SceneDescription& description)
{
	std::set<std::string> labels;
	for (const auto& [name, item] : description.items) labels.insert(item.label);
	return LabelSet({labels.begin(), labels.end()});
}

/** One lamp in the middle of each room. */
std::vector<PointLight> lamps(const SceneDescription& description, const FloorPlan& plan)
{
	std::vector<PointLight> lights;
	for (const auto& room : plan.rooms())
	{
		const Eigen::Vector2d middle = room.footprint().center;
		PointLight light;
		light.position = {
			float(middle.x()), float(middle.y()), float(description.scene.height - kLampDrop)};
		light.intensity = float(description.scene.lightIntensity);
		lights.push_back(light);
	}
	return lights;
}
}  // namespace

BuiltScene buildScene(
	const SceneDescription& description, const FurnitureCatalog& catalog, uint64_t seed)
{
	BuiltScene built{{}, description.floorPlan(), {}};
	built.way = splineThrough(description.waypoints(), description.path.closed);
	try
	{
		requireFreeWay(built.way, built.plan, kCarrierRadius);
	}
	catch (const InputError& error)
	{
		throw InputError(description.file + ": [path] waypoints: " + error.what());
	}
	FurnitureModels models(catalog);
	Scene& scene = built.scene;
	scene.name = std::filesystem::path(description.file).stem().string();
	scene.labels = labelsOf(description);
	scene.objects = furnish(description, built.plan, built.way, models, scene.labels, seed);
	scene.rooms = built.plan.mesh(seed);
	scene.lights = lamps(description, built.plan);
	scene.ambient = float(description.scene.ambient);
	return built;
}

mrpt::img::TCamera cameraOf(const CameraOptions& options)
{
	mrpt::img::TCamera camera;
	camera.ncols = uint32_t(options.width);
	camera.nrows = uint32_t(options.height);
	const double focal = options.width / 2.0 / std::tan(options.fieldOfView / 2);
	camera.setIntrinsicParamsFromValues(
		focal, focal, (options.width - 1) / 2.0, (options.height - 1) / 2.0);
	camera.cameraName = "simulated";
	return camera;
}

}  // namespace semloop
