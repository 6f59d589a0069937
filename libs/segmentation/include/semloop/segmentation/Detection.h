#pragma once

#include <semloop/observations/LabelSet.h>

#include <opencv2/core/mat.hpp>
#include <vector>

namespace semloop
{
/** What a network's raw outputs are filtered with. */
struct DetectionLimits
{
	double minScore = 0.25;       //!< of the best label
	double minLabelScore = 0.05;  //!< of the other labels of a detection
	double maxIou = 0.5;          //!< of two boxes of one label; above, the weaker is dropped
	int maxDetections = 100;
};

/** A box that a network proposes. */
struct Candidate
{
	cv::Rect2d box;      //!< [px] of the image, not clipped
	LabelScores scores;  //!< as the network gives them, highest first, never empty
	int index = 0;       //!< which row or column of the network's output it is
};

/** An object found in an image, with its label numbers still the network's own. */
struct Detection
{
	cv::Rect box;        //!< [px], inside the image
	cv::Mat mask;        //!< CV_8UC1 of the box's size, 255 = object
	LabelScores scores;  //!< as the network gives them, highest first, never empty
};

/** Area of the intersection over that of the union; 0 when both are empty. */
double intersectionOverUnion(const cv::Rect2d& a, const cv::Rect2d& b);

/** Greedy non-maximum suppression, each label for itself: from the highest score down, a candidate is
 *  dropped when its box overlaps one that was kept with the same best label by more than
 *  limits.maxIou. At most limits.maxDetections, highest score first; ties keep the order given. */
std::vector<Candidate> suppressNonMaxima(
	std::vector<Candidate> candidates, const DetectionLimits& limits);

/** The pixels that a box covers by at least half, inside the image. */
cv::Rect pixelBox(const cv::Rect2d& box, cv::Size image);

/** Mask from a coarse grid of values: 255 where the grid, interpolated bilinearly at the pixel's
 *  centre, is above threshold. The grid's cells divide extent evenly, a value sits at the centre of
 *  its cell, and beyond the outermost centres the nearest ones hold.
 *  @param grid CV_32FC1
 *  @param extent what the grid covers [px of the image]
 *  @param box the pixels wanted; the result is CV_8UC1 of its size */
cv::Mat maskFromGrid(
	const cv::Mat& grid, const cv::Rect2d& extent, const cv::Rect& box, float threshold);

}  // namespace semloop
