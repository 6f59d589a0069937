#include <semloop/segmentation/YoloSegDecoder.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace semloop
{
namespace
{
/** Channels x candidates, as a matrix that shares the tensor's memory. */
cv::Mat asMatrix(const cv::Mat& predictions)
{
	return cv::Mat(
		predictions.size[1], predictions.size[2], CV_32F, const_cast<uchar*>(predictions.data));
}

/** A candidate's label scores from minimum on, highest first. */
LabelScores scoresOf(const cv::Mat& channels, int column, int labelCount, double minimum)
{
	LabelScores scores;
	for (int label = 0; label < labelCount; label++)
	{
		const float score = channels.at<float>(4 + label, column);
		if (score > 0 && score >= minimum)
			scores.push_back({uint32_t(label), std::min(score, 1.0f)});
	}
	std::stable_sort(
		scores.begin(), scores.end(),
		[](const LabelScore& a, const LabelScore& b) { return a.score > b.score; });
	return scores;
}

cv::Rect2d boxOf(const cv::Mat& channels, int column, const Letterbox& letterbox)
{
	const double width = channels.at<float>(2, column), height = channels.at<float>(3, column);
	return letterbox.toImage(
		{channels.at<float>(0, column) - width / 2, channels.at<float>(1, column) - height / 2,
		 width, height});
}

bool isUsable(const cv::Rect2d& box, cv::Size image)
{
	const bool finite = std::isfinite(box.x) && std::isfinite(box.y) && std::isfinite(box.width) &&
						std::isfinite(box.height);
	return finite && box.width > 0 && box.height > 0 && !pixelBox(box, image).empty();
}

std::vector<Candidate> candidatesOf(
	const YoloSegOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits)
{
	const cv::Mat channels = asMatrix(outputs.predictions);
	// Row by row: a column's scores lie thousands of floats apart.
	cv::Mat best;
	cv::reduce(channels.rowRange(4, 4 + outputs.labelCount()), best, 0, cv::REDUCE_MAX);

	std::vector<Candidate> candidates;
	for (int column = 0; column < channels.cols; column++)
	{
		if (!(best.at<float>(0, column) >= limits.minScore)) continue;
		Candidate candidate;
		candidate.index = column;
		candidate.box = boxOf(channels, column, letterbox);
		const double minimum = std::min(limits.minLabelScore, double(best.at<float>(0, column)));
		candidate.scores = scoresOf(channels, column, outputs.labelCount(), minimum);
		if (!candidate.scores.empty() && isUsable(candidate.box, letterbox.imageSize()))
			candidates.push_back(std::move(candidate));
	}
	return candidates;
}
}  // namespace

std::optional<YoloSegOutputs> findYoloSegOutputs(
	const std::vector<cv::Mat>& outputs, cv::Size networkSize)
{
	if (outputs.size() != 2) return std::nullopt;
	const std::size_t first = outputs[0].dims == 3 ? 0 : 1;
	const YoloSegOutputs found{outputs[first], outputs[1 - first]};
	const auto& predictions = found.predictions;
	const auto& prototypes = found.prototypes;
	if (predictions.dims != 3 || prototypes.dims != 4) return std::nullopt;
	if (predictions.type() != CV_32F || prototypes.type() != CV_32F) return std::nullopt;
	if (predictions.size[0] != 1 || prototypes.size[0] != 1) return std::nullopt;
	if (prototypes.size[2] * 4 != networkSize.height || prototypes.size[3] * 4 != networkSize.width)
		return std::nullopt;
	// One prediction for each cell of three grids, of 8, 16 and 32 pixels: tells candidates from
	// channels, and YOLOv5's layout (transposed, three anchors a cell) from this one.
	const int cells64 = networkSize.area() / 64;
	if (predictions.size[2] != cells64 + cells64 / 4 + cells64 / 16) return std::nullopt;
	return found.labelCount() > 0 ? std::make_optional(found) : std::nullopt;
}

std::vector<Detection> decodeYoloSeg(
	const YoloSegOutputs& outputs, const Letterbox& letterbox, const DetectionLimits& limits)
{
	const auto kept = suppressNonMaxima(candidatesOf(outputs, letterbox, limits), limits);
	const auto& shape = outputs.prototypes.size;
	const cv::Mat prototypes(
		shape[1], shape[2] * shape[3], CV_32F, const_cast<uchar*>(outputs.prototypes.data));
	const cv::Mat channels = asMatrix(outputs.predictions);
	const cv::Rect2d extent =
		letterbox.toImage(cv::Rect2d({0, 0}, cv::Size2d(letterbox.networkSize())));

	std::vector<Detection> detections;
	for (const auto& candidate : kept)
	{
		const cv::Mat weights =
			channels.col(candidate.index).rowRange(4 + outputs.labelCount(), channels.rows);
		const cv::Mat values = weights.t() * prototypes;
		const cv::Mat grid = values.reshape(1, shape[2]);
		const cv::Rect box = pixelBox(candidate.box, letterbox.imageSize());
		// sigmoid(v) > 1/2 is v > 0
		detections.push_back({box, maskFromGrid(grid, extent, box, 0.0f), candidate.scores});
	}
	return detections;
}

}  // namespace semloop
