#pragma once

#include <exception>
#include <string>

namespace semloop
{
/** What went wrong, in one line: the first of what(), or of what MRPT's exceptions have behind
 *  "Message:", between their banner and a call stack. */
std::string exceptionMessage(const std::exception& e);

}  // namespace semloop
