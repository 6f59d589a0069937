#include <semloop/segmentation/MaskRcnnDecoder.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace semloop
{
namespace
{
constexpr int kTensorflowLabels = 90;
// Counted from 0: street sign, hat, shoe, eye glasses, plate, mirror, window, desk, door, blender.
constexpr std::array<int, 10> kNeverAnnotated = {11, 25, 28, 29, 44, 65, 67, 68, 70, 82};

std::vector<Candidate> candidatesOf(
	const MaskRcnnOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits)
{
	const cv::Mat rows(outputs.boxes.size[2], 7, CV_32F, const_cast<uchar*>(outputs.boxes.data));
	const cv::Size2d network(letterbox.networkSize());
	std::vector<Candidate> candidates;
	for (int i = 0; i < std::min(rows.rows, outputs.masks.size[0]); i++)
	{
		const float* row = rows.ptr<float>(i);
		if (!std::all_of(row, row + 7, [](float value) { return std::isfinite(value); })) continue;
		if (row[2] < limits.minScore || row[1] < 0 || row[1] >= float(outputs.labelCount()))
			continue;
		Candidate candidate;
		candidate.index = i;
		candidate.scores = {{uint32_t(row[1]), std::min(row[2], 1.0f)}};
		candidate.box = letterbox.toImage(
			{row[3] * network.width, row[4] * network.height, (row[5] - row[3]) * network.width,
			 (row[6] - row[4]) * network.height});
		const bool positive = candidate.box.width > 0 && candidate.box.height > 0;
		if (positive && !pixelBox(candidate.box, letterbox.imageSize()).empty())
			candidates.push_back(std::move(candidate));
	}
	return candidates;
}
}  // namespace

std::optional<MaskRcnnOutputs> findMaskRcnnOutputs(const std::vector<cv::Mat>& outputs)
{
	if (outputs.size() != 2) return std::nullopt;
	const auto isBoxes = [](const cv::Mat& m)
	{ return m.dims == 4 && m.size[0] == 1 && m.size[1] == 1 && m.size[3] == 7; };
	const std::size_t first = isBoxes(outputs[0]) ? 0 : 1;
	const MaskRcnnOutputs found{outputs[first], outputs[1 - first]};
	if (!isBoxes(found.boxes) || found.masks.dims != 4) return std::nullopt;
	if (found.boxes.type() != CV_32F || found.masks.type() != CV_32F) return std::nullopt;
	return found;
}

std::vector<Detection> decodeMaskRcnn(
	const MaskRcnnOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits)
{
	const auto kept = suppressNonMaxima(candidatesOf(outputs, letterbox, limits), limits);
	const auto& shape = outputs.masks.size;
	std::vector<Detection> detections;
	for (const auto& candidate : kept)
	{
		const auto* values =
			outputs.masks.ptr<float>(candidate.index, int(candidate.scores.front().label));
		const cv::Mat grid(shape[2], shape[3], CV_32F, const_cast<float*>(values));
		const cv::Rect box = pixelBox(candidate.box, letterbox.imageSize());
		detections.push_back({box, maskFromGrid(grid, candidate.box, box, 0.5f), candidate.scores});
	}
	return detections;
}

std::vector<std::optional<uint32_t>> cocoLabelsOfTensorflow()
{
	std::vector<std::optional<uint32_t>> result(kTensorflowLabels);
	uint32_t next = 0;
	for (int i = 0; i < kTensorflowLabels; i++)
	{
		const bool gap =
			std::find(kNeverAnnotated.begin(), kNeverAnnotated.end(), i) != kNeverAnnotated.end();
		if (!gap) result[std::size_t(i)] = next++;
	}
	return result;
}

}  // namespace semloop
