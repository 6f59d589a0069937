#pragma once

#include <semloop/config/Options.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cstdint>

namespace semloop
{
/** How a network errs; every rate is per object and image unless said otherwise. */
struct SimulatedDetectorOptions : Options
{
	int minimumArea = 100;        //!< smaller ones are never reported [px], at 640 x 480
	double missRate = 0.03;       //!< of a large object in full view
	double missArea = 400;        //!< at this area half of the objects are missed besides [px]
	double missHidden = 0.7;      //!< hidden share at which half are missed besides
	double boundaryNoise = 1.5;   //!< sigma of the mask's edge [px], at 640 x 480
	double splitRate = 0.02;
	double mergeRate = 0.02;      //!< of neighbours of one label
	double falseRate = 0.05;      //!< false detections an image
	double confusionRate = 0.05;  //!< probability that another label leads
	std::string confusionFile;    //!< p(l_k | l_j), see ConfusionMatrix; empty: evenly
	int embeddingSize = 64;
	double embeddingView = 0.35;   //!< share of the part that depends on the viewing direction
	double embeddingNoise = 0.15;  //!< share of noise
	double embeddingClass = 0.5;   //!< share that objects of one label have in common

protected:
	void describe(OptionFields& fields) override;
};

/** Exact masks, true labels with score 1, Instance::trueObject, the embeddings a network would give;
 *  objects of at least one pixel, by id. */
CObservationInstances trueInstances(
	const RenderedView& view, const Scene& scene, const SimulatedDetectorOptions& options,
	uint64_t seed);

/** What a network would report. `hidden[id]` is the share of the object that others hide.
 *  Instance::trueObject is not set. Same seed, same result. */
CObservationInstances detectInstances(
	const RenderedView& view, const std::vector<float>& hidden, const Scene& scene,
	const SimulatedDetectorOptions& options, uint64_t seed);

}  // namespace semloop
