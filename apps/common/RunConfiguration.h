#pragma once

#include <mrpt/config/CConfigFile.h>

#include <string>
#include <vector>

namespace semloop
{
/** A configuration that --set changes for this run only, never on disk. */
class RunConfiguration : public mrpt::config::CConfigFile
{
public:
	/** Throws InputError when the file is not one of sections and keys. */
	explicit RunConfiguration(const std::string& path);
	~RunConfiguration() override;

	/** Each "section.key=value"; throws UsageError on anything else. */
	void apply(const std::vector<std::string>& overrides);
};

}  // namespace semloop
