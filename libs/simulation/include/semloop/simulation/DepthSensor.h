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
	double baseline = 0.075;                         //!< of camera and projector [m]
	double disparityScale = 8.0;                     //!< steps of disparity in a pixel
	double disparitySigma = 1.0 / 6.0;               //!< [steps]
	double lateralSigma = 0.5;                       //!< [px]
	double edge = 0.05;                              //!< never interpolated across [m]
	double minimumCosine = 0.16;                     //!< of the angle of incidence

	void requireConsistent() const override;

protected:
	void describe(OptionFields& fields) override;
};

/** What a structured-light sensor makes of the true depth z: CV_16UC1 in millimetres, 0 = invalid.
 *
 *    z' = K / floor(K / z(x + nx, y + ny) + N(0, disparitySigma^2) + 0.5)
 *
 *  with nx, ny ~ N(0, lateralSigma^2) and K = disparityScale f baseline; at z its RMS error is
 *  z^2 / K sqrt(1 / 12 + disparitySigma^2): 4.2 mm at 2 m with f = 525 px (Barron and Malik, CVPR 2013;
 *  Handa et al., ICRA 2014). Not measured is what lies out of range, is seen too flat, or lies in the
 *  shadow of the projector, which stands on the camera's right (+x) as the Kinect's does: left of a
 *  nearer surface, f baseline (1 / near - 1 / far) pixels wide. What stands outside the image throws
 *  no shadow. Without noise: z within the range, rounded.
 *
 *  Same seed, same image, whatever the thread. An empty view gives an empty image. Throws InputError
 *  for images of a wrong type or size, UsageError when the range is none. */
cv::Mat senseDepth(const RenderedView& view, const DepthSensorOptions& options, uint64_t seed);

}  // namespace semloop
