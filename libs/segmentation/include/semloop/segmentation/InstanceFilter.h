#pragma once

#include <semloop/observations/CObservationInstances.h>
#include <semloop/segmentation/Detection.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace semloop
{
/** For each label number of a network, its index in the label set; empty: not in the set. */
using LabelMapping = std::vector<std::optional<uint32_t>>;

struct InstanceLimits
{
	double minPartArea = 0.0;   //!< separate parts below this share of the largest are removed
	int minArea = 1;            //!< [px]
	double duplicateIou = 1.0;  //!< of two masks of any labels, above which they are one object
};

/** Turns detections, highest score first, into instances: cleans the masks, drops what is too small or
 *  whose best label is not in the set, joins duplicates (the stronger one stays and takes over the
 *  label scores of the weaker, each label with its higher score), and scales the best five label
 *  scores to sum up to 1. An instance's box is that of its mask; its confidence is its best score
 *  before scaling. */
std::vector<Instance> filterInstances(
	const std::vector<Detection>& detections, cv::Size imageSize, const LabelMapping& mapping,
	const InstanceLimits& limits);

/** The mask (CV_8UC1) without its separate parts (8-connected) smaller than share times the largest. */
cv::Mat withoutSmallParts(const cv::Mat& mask, double share);

}  // namespace semloop
