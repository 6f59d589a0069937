#pragma once

#include <opencv2/core/mat.hpp>

#include "PrimitiveParts.h"

namespace semloop
{
// Each draws what a side of a primitive shows: CV_8UC3, BGR, sRGB, at most 512 pixels wide and high.

/** A keyboard from above, its space bar at the lower edge. */
cv::Mat drawKeyboard(SeededRandom& random);
/** A mouse from above: two keys and a wheel, at the upper edge. */
cv::Mat drawMouse(const cv::Scalar& color);
/** A book's front cover: frame, title, author, an ornament. */
cv::Mat drawBookCover(const cv::Scalar& color, SeededRandom& random);
/** A book's edge: the lines of its pages along the longer side. */
cv::Mat drawPages(SeededRandom& random);
/** A monitor's screen: windows with lines of text on a desktop. */
cv::Mat drawScreen(SeededRandom& random);
/** A framed painting of a few shapes. */
cv::Mat drawPicture(SeededRandom& random);
/** A cardboard box's side: adhesive tape and, where asked for, a printed label. */
cv::Mat drawCardboard(bool withLabel, SeededRandom& random);

}  // namespace semloop
