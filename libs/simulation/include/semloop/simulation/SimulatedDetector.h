#pragma once

#include <semloop/config/Options.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cstdint>
#include <string>
#include <vector>

namespace semloop
{
/** How a network errs; every rate is per object and image unless said otherwise. Lengths and areas are
 *  those of an image 640 pixels wide and grow with the width. With all rates and boundaryNoise 0, and
 *  missHidden large, the masks are exact. */
struct SimulatedDetectorOptions : Options
{
	int minimumArea = 100;    //!< smaller ones are never reported [px]
	double missRate = 0.03;   //!< of a large object in full view
	double missArea = 400;    //!< at this area half are missed besides, at thrice it a tenth [px]
	double missHidden = 0.7;  //!< hidden share at which half are missed besides; at 0.5: 5 %
	double boundaryNoise = 1.5;  //!< sigma of the mask's edge [px]
	double splitRate = 0.02;
	double mergeRate = 0.02;      //!< of two neighbours of one label
	double falseRate = 0.05;      //!< mean number of false detections in an image
	double confusionRate = 0.05;  //!< probability that another label leads, any as likely
	/** "chair>couch:0.2": a chair is called a couch with this probability; in place of confusionRate
	 *  for the labels on the left. */
	std::vector<std::string> confusions;
	int embeddingSize = 64;  //!< 0: none
	/** Parts of the embedding, as shares of its squared length, so that they are cosine similarities;
	 *  what they leave to 1 is identity. Two objects of one label have embeddingClass. */
	double embeddingClass = 0.3;
	double embeddingView = 0.2;      //!< of the viewing direction, turns against itself at the back
	double embeddingNoise = 0.07;    //!< other in each image
	double embeddingInstance = 0.3;  //!< of identity: not shared with objects of the same model

	void requireConsistent() const override;

protected:
	void describe(OptionFields& fields) override;
};

/** Exact masks, true labels with score 1, Instance::trueObject, the embeddings a network would give;
 *  objects of at least one pixel, by id. Camera and labels are those of the view and the scene;
 *  sensorPose, timestamp and sensorLabel are left to the caller. Throws InputError when the view has an
 *  object that the scene has not, or a size other than its camera's, or an object a label that is not
 *  in the set; UsageError when the shares of the embedding sum to more than 1. */
CObservationInstances trueInstances(
	const RenderedView& view, const Scene& scene, const SimulatedDetectorOptions& options,
	uint64_t seed);

/** What a network would report, the most confident first; no pixel belongs to two masks.
 *  `hidden[id]` is the share of the object that others hide; an empty list: nothing is hidden.
 *  Instance::trueObject is not set. Same seed, same result. Throws like trueInstances(), and InputError
 *  when `hidden` is too short, UsageError for a confusion that cannot be read. */
CObservationInstances detectInstances(
	const RenderedView& view, const std::vector<float>& hidden, const Scene& scene,
	const SimulatedDetectorOptions& options, uint64_t seed);

}  // namespace semloop
