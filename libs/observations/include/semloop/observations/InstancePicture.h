#pragma once

#include <mrpt/img/TColor.h>
#include <semloop/observations/CObservationInstances.h>

#include <opencv2/core/mat.hpp>
#include <string>

namespace semloop
{
/** The colour that a label has in every picture: its hue comes from a hash of the name (FNV-1a, Fowler,
 *  Noll and Vo), so that it does not depend on the label set. */
mrpt::img::TColor labelColor(const std::string& label);

/** The masks over the colour image (CV_8UC3, BGR, of their size; empty: over dark grey), each in its
 *  label's colour with a darker edge and, where there is room, the label's name. Smaller masks lie on
 *  larger ones. Throws InputError when the image has another size or type. */
cv::Mat drawInstances(const CObservationInstances& observation, const cv::Mat& color = {});

}  // namespace semloop
