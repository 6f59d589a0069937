#pragma once

#include <semloop/segmentation/Detection.h>
#include <semloop/segmentation/Letterbox.h>

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace semloop
{
/** The outputs of a YOLO segmentation network as Ultralytics exports them (YOLOv8, YOLO11): one
 *  column a candidate, and the prototypes that its mask is a weighted sum of (Bolya et al., YOLACT,
 *  ICCV 2019, Eq. 1). */
struct YoloSegOutputs
{
	cv::Mat
		predictions;  //!< [1, 4 + C + P, N]: cx, cy, w, h [px of the network], C scores, P weights
	cv::Mat prototypes;  //!< [1, P, H / 4, W / 4]

	int labelCount() const { return predictions.size[1] - 4 - prototypes.size[1]; }
};

/** Picks these two out of a network's outputs by their shapes; empty when they are not of this layout. */
std::optional<YoloSegOutputs> findYoloSegOutputs(
	const std::vector<cv::Mat>& outputs, cv::Size networkSize);

/** Detections in the image: mask = sigmoid(weights . prototypes) > 1/2 inside the box, interpolated
 *  before thresholding. Candidates that are not finite or lie outside the image are dropped. */
std::vector<Detection> decodeYoloSeg(
	const YoloSegOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits);

}  // namespace semloop
