#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <semloop/segmentation/Embedder.h>
#include <semloop/segmentation/Segmenter.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace semloop
{
/** What the command line says. */
struct Arguments
{
	std::string rawlog;
	std::string model;
	std::string modelConfig;             //!< .pbtxt of a TensorFlow network
	std::string embeddingModel;          //!< empty: colour histograms
	std::string labels;                  //!< empty: COCO
	std::string output;                  //!< the sidecar
	double minScore = -1;                //!< negative: the option's default
	std::vector<std::string> overrides;  //!< section.key=value
	int every = 1;
	bool depthCrops = false;
	bool force = false;
};

/** The two networks, ready to run, and what their results depend on. */
struct Networks
{
	Segmenter::Ptr segmenter;
	Embedder::Ptr embedder;
	nlohmann::json settings;  //!< goes into the sidecar, which is only continued with the same
};

/** Throws UsageError and InputError as the modules do. */
Networks loadNetworks(const Arguments& arguments);

}  // namespace semloop
