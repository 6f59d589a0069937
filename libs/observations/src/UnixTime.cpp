#include <semloop/observations/UnixTime.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace semloop
{
namespace
{
using Ticks = int64_t;
constexpr Ticks kTicksPerSecond = mrpt::Clock::period::den;
constexpr Ticks kTicksPerMicrosecond = kTicksPerSecond / 1'000'000;
constexpr double kLargestSeconds = 1e11;  // the year 5138

mrpt::Clock::time_point fromUnixTicks(Ticks ticks)
{
	return mrpt::Clock::fromDouble(0) + mrpt::Clock::duration(ticks);
}

Ticks unixTicks(mrpt::Clock::time_point time)
{
	return (time - mrpt::Clock::fromDouble(0)).count();
}

/** Ticks in ".374112": digits beyond the clock's resolution are rounded. */
std::optional<Ticks> parseFraction(std::string_view digits)
{
	Ticks ticks = 0, unit = kTicksPerSecond;
	for (std::size_t i = 0; i < digits.size(); i++)
	{
		if (digits[i] < '0' || digits[i] > '9') return std::nullopt;
		unit /= 10;
		const int digit = digits[i] - '0';
		if (unit > 0)
			ticks += digit * unit;
		else
			return digit >= 5 ? ticks + 1 : ticks;
	}
	return ticks;
}

std::optional<mrpt::Clock::time_point> parseAsDouble(std::string_view text)
{
	double seconds = 0;
	const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
	if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
	if (!(seconds >= 0 && seconds < kLargestSeconds)) return std::nullopt;
	return fromUnixTicks(Ticks(std::llround(seconds * double(kTicksPerSecond))));
}

}  // namespace

std::optional<mrpt::Clock::time_point> parseUnixTime(std::string_view text)
{
	Ticks seconds = 0;
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, seconds);
	if (error == std::errc() && seconds >= 0 && double(seconds) < kLargestSeconds)
	{
		if (end == last) return fromUnixTicks(seconds * kTicksPerSecond);
		const auto fraction =
			*end == '.' ? parseFraction({end + 1, std::size_t(last - end - 1)}) : std::nullopt;
		if (fraction) return fromUnixTicks(seconds * kTicksPerSecond + *fraction);
	}
	return parseAsDouble(text);
}

std::string formatUnixTime(mrpt::Clock::time_point time)
{
	Ticks microseconds = (unixTicks(time) + kTicksPerMicrosecond / 2) / kTicksPerMicrosecond;
	const char* const sign = microseconds < 0 ? "-" : "";  // before 1970: a missing time is
	microseconds = std::abs(microseconds);
	char text[32];
	std::snprintf(
		text, sizeof(text), "%s%lld.%06lld", sign, static_cast<long long>(microseconds / 1'000'000),
		static_cast<long long>(microseconds % 1'000'000));
	return text;
}

}  // namespace semloop
