#pragma once

#include <semloop/simulation/SimulatedDetector.h>

#include <cstdint>
#include <vector>

#include "VisibleObjects.h"

namespace semloop
{
/** What a network takes for one object. */
struct SimulatedMask
{
	std::vector<const SceneObject*> objects;  //!< two: merged; none: a false detection
	InstanceMask mask;                        //!< never empty
	uint64_t key = 0;                         //!< other for each mask and image
};

/** Width of the image / 640: what lengths in the options are multiplied with. */
double imageScale(const RenderedView& view);

/** Area as the options count it [px at a width of 640]. */
double scaledArea(const InstanceMask& mask, const RenderedView& view);

/** Masks of the objects that were not missed: merged, with noisy outlines, split, disjoint; those below
 *  minimumArea left out. Then false detections: parts of ellipses where the view shows one thing, or
 *  none, that nothing else was reported for. */
std::vector<SimulatedMask> simulatedMasks(
	const RenderedView& view, const std::vector<VisibleObject>& objects,
	const SimulatedDetectorOptions& options, uint64_t seed);

}  // namespace semloop
