#pragma once

#include <semloop/observations/InstanceMask.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cstdint>
#include <vector>

namespace semloop
{
/** An object in a view. */
struct VisibleObject
{
	const SceneObject* object = nullptr;
	InstanceMask mask;  //!< exact, never empty
};

/** Those with at least one pixel, by id. Throws InputError when view, camera and scene do not fit. */
std::vector<VisibleObject> visibleObjects(const RenderedView& view, const Scene& scene);

}  // namespace semloop
