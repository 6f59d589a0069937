#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/Furnishing.h>
#include <semloop/simulation/Primitives.h>
#include <semloop/simulation/SceneBuilder.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace semloop
{
namespace
{
constexpr double kCarrierRadius = 0.2;  // [m]
constexpr double kLampSpacing = 3.0;    // [m]
constexpr double kLampDrop = 0.25;      // of a lamp below the ceiling [m]

LabelSet labelsOf(const SceneDescription& description)
{
	std::set<std::string> labels;
	for (const auto& [name, item] : description.items) labels.insert(item.label);
	return LabelSet({labels.begin(), labels.end()});
}

/** At least two in each room, in a row along its longer side. */
std::vector<PointLight> lamps(const SceneDescription& description, const FloorPlan& plan)
{
	std::vector<PointLight> lights;
	for (const auto& room : plan.rooms())
	{
		const int along = room.size.x() >= room.size.y() ? 0 : 1;
		const int count = std::max(2, int(std::lround(room.size[along] / kLampSpacing)));
		for (int i = 0; i < count; ++i)
		{
			Eigen::Vector2d place = room.footprint().center;
			place[along] = room.corner[along] + room.size[along] * (i + 0.5) / count;
			PointLight light;
			light.position = {
				float(place.x()), float(place.y()), float(description.scene.height - kLampDrop)};
			light.intensity = float(description.scene.lightIntensity);
			lights.push_back(light);
		}
	}
	return lights;
}

/** All models that may be drawn, so that an error does not depend on the seed. */
void requireModels(const SceneDescription& description, const FurnitureCatalog& catalog)
{
	const std::string primitive = "primitive:";
	for (const auto& [name, item] : description.items)
		for (const auto& id : item.models) try
			{
				if (id.rfind(primitive, 0) == 0)
					requirePrimitive(id.substr(primitive.size()));
				else
					catalog.entry(id);
			}
			catch (const InputError& error)
			{
				throw InputError(
					description.modelsFile + ": [" + name + "] models: " + error.what());
			}
}

/** The way, of which a carrier with his camera has room. */
std::vector<Eigen::Vector2d> freeWay(const SceneDescription& description, const FloorPlan& plan)
{
	const PathOptions& path = description.path;
	if (path.minimumHeight > path.maximumHeight ||
		path.maximumHeight > description.scene.height - 0.1)
		throw UsageError(mrpt::format(
			"%s: [path] minimum_height = %g, maximum_height = %g: not allowed; the first is at "
			"most the "
			"second, and that 0.1 below [scene] height = %g",
			description.file.c_str(), path.minimumHeight, path.maximumHeight,
			description.scene.height));
	try
	{
		auto way = splineThrough(description.waypoints(), path.closed);
		requireFreeWay(way, plan, kCarrierRadius);
		return way;
	}
	catch (const InputError& error)
	{
		throw InputError(description.file + ": [path] waypoints: " + error.what());
	}
}
}  // namespace

BuiltScene buildScene(
	const SceneDescription& description, const FurnitureCatalog& catalog, uint64_t seed)
{
	BuiltScene built{{}, description.floorPlan(), {}};
	built.way = freeWay(description, built.plan);
	requireModels(description, catalog);
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
