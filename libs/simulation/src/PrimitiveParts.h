#pragma once

#include <semloop/simulation/Mesh.h>

#include <array>
#include <cstdint>
#include <random>

namespace semloop
{
/** Random numbers that are the same with every standard library, unlike std's distributions. */
class SeededRandom
{
public:
	explicit SeededRandom(uint64_t seed) : engine_(seed) {}

	/** In [low, high). */
	double uniform(double low, double high)
	{
		constexpr double kPerStep = 1.0 / 9007199254740992.0;  // 2^-53
		return low + (high - low) * kPerStep * static_cast<double>(engine_() >> 11U);
	}
	/** One of low, ..., high. */
	int integer(int low, int high) { return static_cast<int>(uniform(low, high + 1.0)); }

	/** sRGB in BGR order; saturation and value in [0, 1], any hue. */
	cv::Scalar color(double saturation, double value);

private:
	std::mt19937_64 engine_;
};

/** Appends a plain material of an sRGB colour (BGR, 0 to 255); returns its index. */
uint32_t addColor(Mesh& mesh, const cv::Scalar& srgb);

/** Appends a material with this texture; returns its index. */
uint32_t addTexture(Mesh& mesh, const cv::Mat& texture);

/** Materials of a box's sides; each shows its texture once, upright, as seen from outside. The top's
 *  texture has its lower edge at the front, the bottom's its upper. */
struct BoxMaterials
{
	uint32_t front = 0, back = 0, left = 0, right = 0, top = 0, bottom = 0;

	static BoxMaterials all(uint32_t material);
};

/** Appends an axis-parallel box, 12 triangles, counterclockwise as seen from outside. */
void addBox(
	Mesh& mesh, const Eigen::Vector3f& minimum, const Eigen::Vector3f& maximum,
	const BoxMaterials& materials);

/** Appends the upper half of an ellipsoid that stands on z = 0 around the origin, with a flat bottom.
 *  Its texture is as seen from above, the lower edge at the front. */
void addDome(Mesh& mesh, const Eigen::Vector3f& size, uint32_t material);

}  // namespace semloop
