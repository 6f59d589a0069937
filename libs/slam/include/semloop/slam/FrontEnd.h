#pragma once

#include <semloop/observations/RgbdFrame.h>
#include <semloop/segmentation/Embedder.h>
#include <semloop/segmentation/Segmenter.h>

#include <memory>

namespace semloop
{
/** Images to instances: what runs ahead of the mapping. */
struct FrontEnd
{
	std::shared_ptr<Segmenter> segmenter;
	std::shared_ptr<Embedder> embedder;  //!< null: instances stay as they come

	/** The instances of an image as recorded; null when it is not segmented. */
	CObservationInstances::Ptr instancesOf(const RgbdFrame& raw) const;
	/** Embeddings for the instances that have none yet. */
	void embed(const RgbdFrame& raw, CObservationInstances& instances) const;
};

}  // namespace semloop
