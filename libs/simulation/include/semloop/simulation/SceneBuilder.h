#pragma once

#include <mrpt/img/TCamera.h>
#include <semloop/simulation/FloorPlan.h>
#include <semloop/simulation/FurnitureCatalog.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneDescription.h>

#include <cstdint>

namespace semloop
{
/** A scene and the way of the camera through it. */
struct BuiltScene
{
	Scene scene;
	FloorPlan plan;
	std::vector<Eigen::Vector2d> way;  //!< once, in steps of about 2 cm
};

/** Walls, furniture, lamps and the way. Throws InputError or UsageError, naming the scene's file. */
BuiltScene buildScene(
	const SceneDescription& description, const FurnitureCatalog& catalog, uint64_t seed);

/** The camera that the description asks for: a pinhole, its centre in the image's. */
mrpt::img::TCamera cameraOf(const CameraOptions& options);

}  // namespace semloop
