#pragma once

#include <exception>
#include <string>

namespace semloop
{
/** What went wrong, in one line: the first of what() or, of MRPT's exceptions, which come in banners and
 *  call stacks, of the inmost message. */
std::string exceptionMessage(const std::exception& e);

}  // namespace semloop
