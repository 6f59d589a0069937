#include "RunConfiguration.h"

#include <semloop/config/Error.h>

namespace semloop
{
RunConfiguration::RunConfiguration(const std::string& path)
try : CConfigFile(path)
{
}
catch (const std::exception&)
{
	throw InputError(path + ": cannot be read as a configuration; give an ini file");
}

RunConfiguration::~RunConfiguration()
{
	// MRPT would save the overrides otherwise.
	discardSavingChanges();
}

void RunConfiguration::apply(const std::vector<std::string>& overrides)
{
	for (const auto& text : overrides)
	{
		const auto equals = text.find('=');
		// A section's name may have dots, a key's has not.
		const auto dot = text.rfind('.', equals);
		if (equals == std::string::npos || dot == std::string::npos || dot == 0)
			throw UsageError("--set " + text + ": write section.key=value");
		write(text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1));
	}
}

}  // namespace semloop
