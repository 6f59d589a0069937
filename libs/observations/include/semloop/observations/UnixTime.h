#pragma once

#include <mrpt/core/Clock.h>

#include <optional>
#include <string>
#include <string_view>

namespace semloop
{
/** Reads seconds since 1970, as "1305031453.374112" or in any other decimal form. Exact to the
 *  clock's 100 ns, which a double is not. Empty when the whole text is not such a number. */
std::optional<mrpt::Clock::time_point> parseUnixTime(std::string_view text);

/** Seconds since 1970 with six decimals, rounded. */
std::string formatUnixTime(mrpt::Clock::time_point time);

}  // namespace semloop
