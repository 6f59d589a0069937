#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <string>

namespace semloop
{
/** A text of an ini file without the comment behind it, empty when it is missing: MRPT strips comments
 *  that begin with // or # and leaves "; ..." in the text. */
std::string readText(
	const mrpt::config::CConfigFileBase& source, const std::string& section,
	const std::string& key);

}  // namespace semloop
