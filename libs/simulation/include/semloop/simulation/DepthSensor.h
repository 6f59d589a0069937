#pragma once

#include <semloop/config/Options.h>
#include <semloop/simulation/SceneRenderer.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace semloop
{
struct DepthSensorOptions : Options
{
	bool noise = true;
	double minimumRange = 0.45, maximumRange = 6.0;  //!< [m]
	double baseline = 0.075;             //!< of camera and projector [m]
	double disparityScale = 8.0;         //!< steps of disparity in a pixel
	double disparitySigma = 1.0 / 6.0;   //!< [steps]
	double lateralSigma = 0.5;           //!< [px]
	double edge = 0.05;                  //!< never interpolated across [m]
	double minimumCosine = 0.16;         //!< of the angle of incidence

protected:
	void describe(OptionFields& fields) override;
};

/** What a structured-light sensor makes of the true depth: CV_16UC1 in millimetres, 0 = invalid. Same
 *  seed, same image, whatever the thread. See the .cpp for the model (Barron and Malik, CVPR 2013;
 *  Handa et al., ICRA 2014). */
cv::Mat senseDepth(const RenderedView& view, const DepthSensorOptions& options, uint64_t seed);

}  // namespace semloop
