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

/** The colour image of a camera with automatic exposure and noise: CV_8UC3, BGR, sRGB. `time` [s] since
 *  the start moves the exposure. Same seed, same image. */
cv::Mat senseColor(
	const RenderedView& view, const ColorSensorOptions& options, double time, uint64_t seed);

}  // namespace semloop
