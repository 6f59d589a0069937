#pragma once

#include <semloop/segmentation/Detection.h>
#include <semloop/segmentation/Letterbox.h>

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace semloop
{
/** The outputs of a Mask R-CNN (He et al., ICCV 2017) of TensorFlow's Object Detection API, as
 *  OpenCV's tf_text_graph_mask_rcnn.py prepares it. */
struct MaskRcnnOutputs
{
	cv::Mat boxes;  //!< [1, 1, N, 7]: image, label, score, left, top, right, bottom in [0, 1]
	cv::Mat masks;  //!< [N, C, h, w]: probabilities, one small mask a label

	int labelCount() const { return masks.size[1]; }
};

/** Picks these two out of a network's outputs by their shapes; empty when they are not of this layout. */
std::optional<MaskRcnnOutputs> findMaskRcnnOutputs(const std::vector<cv::Mat>& outputs);

/** Detections in the image: of the mask of a box's label, the part with a probability above 1/2.
 *  The network names one label a box; limits.minLabelScore has no effect. */
std::vector<Detection> decodeMaskRcnn(
	const MaskRcnnOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits);

/** TensorFlow's COCO networks count 90 labels, ten of which were never annotated. For each, its index
 *  in LabelSet::coco(), or empty. */
std::vector<std::optional<uint32_t>> cocoLabelsOfTensorflow();

}  // namespace semloop
