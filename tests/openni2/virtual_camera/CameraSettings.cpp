#include "CameraSettings.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace semloop::virtual_camera
{
namespace
{
std::string environment(const std::string& name)
{
	const char* const value = std::getenv(name.c_str());
	return value ? value : "";
}

template <class Number>
std::optional<Number> parse(std::string_view text)
{
	Number value{};
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, value);
	if (error != std::errc() || end != last) return std::nullopt;
	return value;
}

/** A variable of the environment, which must lie in [least, most]. */
template <class Number>
Number number(const std::string& name, Number otherwise, Number least, Number most)
{
	const std::string text = environment(name);
	if (text.empty()) return otherwise;
	const auto value = parse<Number>(text);
	if (!value || !(*value >= least && *value <= most))
		throw std::runtime_error(
			name + "=" + text + ": must be a number from " + std::to_string(least) + " to " +
			std::to_string(most));
	return *value;
}

int count(const std::string& name, int otherwise)
{
	return number(name, otherwise, 1, std::numeric_limits<int>::max());
}

void readStall(CameraSettings& settings)
{
	const std::string name = "SEMLOOP_CAMERA_STALL", text = environment(name);
	if (text.empty()) return;
	const auto colon = text.find(':');
	const auto before = parse<int>(text.substr(0, colon));
	const auto seconds = colon < text.size() ? parse<double>(text.substr(colon + 1)) : std::nullopt;
	if (!before || *before < 0 || !seconds || !(*seconds >= 0 && *seconds < 1e6))
		throw std::runtime_error(name + "=" + text + ": must be FRAME:SECONDS");
	settings.stallBefore = *before;
	settings.stallSeconds = *seconds;
}
}  // namespace

CameraSettings settingsFromEnvironment()
{
	CameraSettings settings;
	settings.rawlog = environment("SEMLOOP_CAMERA_RAWLOG");
	settings.rate = number("SEMLOOP_CAMERA_RATE", settings.rate, 0.1, 10000.0);
	settings.drop = count("SEMLOOP_CAMERA_DROP", settings.drop);
	settings.dropColor = count("SEMLOOP_CAMERA_DROP_COLOR", settings.dropColor);
	settings.unplug = count("SEMLOOP_CAMERA_UNPLUG", settings.unplug);
	readStall(settings);
	return settings;
}

}  // namespace semloop::virtual_camera
