#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <semloop/slam/FrontEnd.h>

#include <string>
#include <vector>

namespace semloop
{
/** Names of the sections that a configuration may have. */
const std::vector<std::string>& configurationSections();

/** Loads the plug-ins of [modules] and makes its segmenter and embedder. */
FrontEnd makeFrontEnd(const mrpt::config::CConfigFileBase& config);

/** The manual's page on configuration, in Markdown: every section with every key of the modules that
 *  semloop comes with. doc/configuration.md is this text. */
std::string configurationReference();

}  // namespace semloop
