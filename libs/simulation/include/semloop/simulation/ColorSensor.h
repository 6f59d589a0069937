#pragma once

#include <semloop/config/Options.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace semloop
{
struct ColorSensorOptions : Options
{
	double exposureDrift = 0.1;    //!< relative amplitude of the slow exposure change
	double exposurePeriod = 15.0;  //!< [s]
	double readNoise = 1.5;        //!< sigma, of 255, in the dark
	double shotNoise = 2.5;        //!< sigma, of 255, at full exposure; grows with its root

protected:
	void describe(OptionFields& fields) override;
};

/** The colour image of a camera with automatic exposure and noise: CV_8UC3, BGR, sRGB (IEC 61966-2-1).
 *  A linear value v, times 1 + exposureDrift sin(2 pi time / exposurePeriod), time [s] since the start,
 *  and cut at 1, becomes
 *
 *    255 srgb(v) + N(0, readNoise^2 + shotNoise^2 v)
 *
 *  so that the noise is what one measures in the image. Same seed, same image; give each image another.
 *  An empty view gives an empty image. Throws InputError for a view without colour. */
cv::Mat senseColor(
	const RenderedView& view, const ColorSensorOptions& options, double time, uint64_t seed);

}  // namespace semloop
