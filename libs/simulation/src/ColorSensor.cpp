#include <semloop/config/Error.h>
#include <semloop/simulation/ColorSensor.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "Random.h"

namespace semloop
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
// Fine enough where the gamma curve is steepest: a step there is a fifth of a grey level.
constexpr int kLevels = 1 << 14;

/** What a linear value becomes: mean and sigma in the image, of 255. */
struct Response
{
	float mean = 0, sigma = 0;
};
using ResponseTable = std::array<Response, kLevels + 1>;

/** IEC 61966-2-1. */
double encodedSrgb(double linear)
{
	return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<float, kLevels + 1> makeGammaTable()
{
	std::array<float, kLevels + 1> table{};
	for (int i = 0; i <= kLevels; i++) table[i] = float(255 * encodedSrgb(double(i) / kLevels));
	return table;
}

ResponseTable makeResponseTable(const ColorSensorOptions& o)
{
	static const auto gamma = makeGammaTable();
	const auto read = float(o.readNoise), shot = float(o.shotNoise);
	ResponseTable table;
	for (int i = 0; i <= kLevels; i++)
		table[i] = {gamma[i], std::sqrt(read * read + shot * shot * float(i) / kLevels)};
	return table;
}
}  // namespace

void ColorSensorOptions::describe(OptionFields& f)
{
	f.number("exposure_drift", exposureDrift, 0, 0.9, "relative amplitude of the exposure");
	f.number("exposure_period", exposurePeriod, 0.01, 1e6, "of the exposure's change [s]");
	f.number("read_noise", readNoise, 0, 255, "sigma in the dark, of 255 in the image");
	f.number("shot_noise", shotNoise, 0, 255, "sigma at full exposure, of 255 in the image");
}

cv::Mat senseColor(
	const RenderedView& view, const ColorSensorOptions& o, double time, uint64_t seed)
{
	if (view.depth.empty() && view.color.empty()) return {};
	if (view.color.type() != CV_32FC3)
		throw InputError(
			"view to sense: it has no colour of 3 x 32-bit floats; render it with colour");

	const double gain = 1 + o.exposureDrift * std::sin(2 * kPi * time / o.exposurePeriod);
	const auto scale = float(gain * kLevels);
	const ResponseTable table = makeResponseTable(o);
	const NormalTable& normal = normalTable();
	RandomStream random(hashed(seed));
	cv::Mat result(view.color.size(), CV_8UC3);
	for (int y = 0; y < result.rows; y++)
	{
		const float* in = view.color.ptr<float>(y);
		uint8_t* out = result.ptr<uint8_t>(y);
		for (int x = 0; x < result.cols; x++, in += 3, out += 3)
		{
			const uint64_t bits = random.bits();
			for (int c = 0; c < 3; c++)
			{
				const float level = std::clamp(in[c] * scale + 0.5F, 0.0F, float(kLevels));
				const Response& r = table[int(level)];
				const float value = r.mean + r.sigma * normal(bits >> (c * NormalTable::kBits));
				out[c] = uint8_t(std::clamp(value + 0.5F, 0.0F, 255.0F));
			}
		}
	}
	return result;
}

}  // namespace semloop
