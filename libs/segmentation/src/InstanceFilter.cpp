#include <semloop/segmentation/InstanceFilter.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
constexpr std::size_t kMaxLabelScores = 5;

void sortByScore(LabelScores& scores)
{
	std::stable_sort(
		scores.begin(), scores.end(),
		[](const LabelScore& a, const LabelScore& b) { return a.score > b.score; });
}

LabelScores mapped(const LabelScores& scores, const LabelMapping& mapping)
{
	LabelScores result;
	for (const auto& s : scores)
		if (s.label < mapping.size() && mapping[s.label])
			result.push_back({*mapping[s.label], s.score});
	return result;
}

/** Each label with the higher of its two scores. */
void takeOver(LabelScores& scores, const LabelScores& others)
{
	for (const auto& other : others)
	{
		const auto same = std::find_if(
			scores.begin(), scores.end(), [&](const auto& s) { return s.label == other.label; });
		if (same == scores.end())
			scores.push_back(other);
		else
			same->score = std::max(same->score, other.score);
	}
	sortByScore(scores);
}

void normalise(LabelScores& scores)
{
	if (scores.size() > kMaxLabelScores) scores.resize(kMaxLabelScores);
	double sum = 0;
	for (const auto& s : scores) sum += s.score;
	for (auto& s : scores) s.score = float(s.score / sum);
}

/** The instance that this detection is, with its scores not yet scaled; empty when it is to be dropped. */
std::optional<Instance> instanceFrom(
	const Detection& detection, cv::Size imageSize, const LabelMapping& mapping,
	const InstanceLimits& limits)
{
	const auto best = detection.scores.front().label;
	if (best >= mapping.size() || !mapping[best]) return std::nullopt;

	Instance instance;
	instance.mask = InstanceMask::encode(
		withoutSmallParts(detection.mask, limits.minPartArea), detection.box.tl(), imageSize);
	if (instance.mask.area() < std::size_t(std::max(1, limits.minArea))) return std::nullopt;
	instance.box = instance.mask.boundingBox();
	instance.confidence = detection.scores.front().score;
	instance.labelScores = mapped(detection.scores, mapping);
	return instance;
}
}  // namespace

std::vector<Instance> filterInstances(
	const std::vector<Detection>& detections, cv::Size imageSize, const LabelMapping& mapping,
	const InstanceLimits& limits)
{
	std::vector<Instance> instances;
	for (const auto& detection : detections)
	{
		auto instance = instanceFrom(detection, imageSize, mapping, limits);
		if (!instance) continue;
		const auto stronger = std::find_if(
			instances.begin(), instances.end(),
			[&](const Instance& other)
			{ return intersectionOverUnion(other.mask, instance->mask) > limits.duplicateIou; });
		if (stronger == instances.end())
			instances.push_back(std::move(*instance));
		else
			takeOver(stronger->labelScores, instance->labelScores);
	}
	for (auto& instance : instances) normalise(instance.labelScores);
	return instances;
}

cv::Mat withoutSmallParts(const cv::Mat& mask, double share)
{
	if (share <= 0 || mask.empty()) return mask;
	cv::Mat parts, statistics, centroids;
	const int count = cv::connectedComponentsWithStats(mask, parts, statistics, centroids);
	if (count <= 2) return mask;

	const auto areaOf = [&](int part) { return statistics.at<int>(part, cv::CC_STAT_AREA); };
	int largest = 0;
	for (int part = 1; part < count; part++) largest = std::max(largest, areaOf(part));
	cv::Mat result(mask.size(), CV_8UC1);
	for (int y = 0; y < mask.rows; y++)
		for (int x = 0; x < mask.cols; x++)
		{
			const int part = parts.at<int>(y, x);
			result.at<uint8_t>(y, x) = part > 0 && areaOf(part) >= share * largest ? 255 : 0;
		}
	return result;
}

}  // namespace semloop
