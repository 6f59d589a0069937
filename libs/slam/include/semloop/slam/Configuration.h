#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <semloop/segmentation/Embedder.h>
#include <semloop/segmentation/Segmenter.h>

#include <memory>
#include <string>
#include <vector>

namespace semloop
{
/** Names of the sections that a configuration may have. */
const std::vector<std::string>& configurationSections();

/** The front end that runs ahead of the mapping; embedder is null when embedder is left empty. */
struct FrontEnd
{
	std::shared_ptr<Segmenter> segmenter;
	std::shared_ptr<Embedder> embedder;
};
/** Loads the plug-ins of [modules] and makes its segmenter and embedder. */
FrontEnd makeFrontEnd(const mrpt::config::CConfigFileBase& config);

/** The manual's page on configuration, in Markdown: every section with every key of the modules that
 *  semloop comes with. doc/configuration.md is this text. */
std::string configurationReference();

}  // namespace semloop
