#include "MaskedCrop.h"

#include <mrpt/core/initializer.h>
#include <semloop/segmentation/ColorHistogramEmbedder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(ColorHistogramEmbedder, Embedder, semloop)

namespace
{
MRPT_INITIALIZER(registerColorHistogramEmbedder)
{
	mrpt::rtti::registerClass(CLASS_ID(ColorHistogramEmbedder));
}

/** The two bins that a value is shared between. */
struct Share
{
	int bin = 0;
	int next = 0;
	double weight = 0;  //!< of next
};

/** Bins divide [low, high] evenly; values outside count for the outermost bin. */
Share shareOf(double value, double low, double high, int bins)
{
	const double position =
		std::clamp((value - low) / (high - low) * bins - 0.5, 0.0, double(bins - 1));
	const int bin = int(position);
	return {bin, std::min(bin + 1, bins - 1), position - bin};
}

/** Histogram over lightness x a* x b*, in a row. */
class LabHistogram
{
public:
	explicit LabHistogram(const ColorHistogramEmbedderOptions& o)
		: options_(o), counts_(std::size_t(o.lightnessBins * o.colorBins * o.colorBins))
	{
	}

	void add(const cv::Vec3f& lab)
	{
		const double chroma = options_.maxChroma;
		const Share l = shareOf(lab[0], 0, 100, options_.lightnessBins);
		const Share a = shareOf(lab[1], -chroma, chroma, options_.colorBins);
		const Share b = shareOf(lab[2], -chroma, chroma, options_.colorBins);
		for (const auto& [binL, weightL] : both(l))
			for (const auto& [binA, weightA] : both(a))
				for (const auto& [binB, weightB] : both(b))
					counts_[index(binL, binA, binB)] += weightL * weightA * weightB;
	}

	const std::vector<double>& counts() const { return counts_; }

private:
	static std::array<std::pair<int, double>, 2> both(const Share& s)
	{
		return {{{s.bin, 1 - s.weight}, {s.next, s.weight}}};
	}

	std::size_t index(int l, int a, int b) const
	{
		return std::size_t((l * options_.colorBins + a) * options_.colorBins + b);
	}

	const ColorHistogramEmbedderOptions& options_;
	std::vector<double> counts_;
};
}  // namespace

void ColorHistogramEmbedderOptions::describe(OptionFields& fields)
{
	fields.integer("lightness_bins", lightnessBins, 1, 64, "bins of the lightness L*");
	fields.integer("color_bins", colorBins, 1, 64, "bins of each of the colour axes a* and b*");
	fields.number(
		"max_chroma", maxChroma, 1, 128, "a* and b* are divided into bins from minus to plus this");
}

void ColorHistogramEmbedder::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options_.loadFromConfigFile(config, section);
}

std::vector<float> ColorHistogramEmbedder::embed(const cv::Mat& color, const Instance& instance)
{
	if (instance.mask.empty()) return {};
	const MaskedCrop crop = maskedCrop(color, instance, "ColorHistogramEmbedder");
	cv::Mat lab;
	crop.color.convertTo(lab, CV_32F, 1.0 / 255.0);
	cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);

	LabHistogram histogram(options_);
	for (int y = 0; y < lab.rows; y++)
		for (int x = 0; x < lab.cols; x++)
			if (crop.mask.at<uint8_t>(y, x)) histogram.add(lab.at<cv::Vec3f>(y, x));

	std::vector<float> embedding;
	for (const double count : histogram.counts()) embedding.push_back(float(std::sqrt(count)));
	normaliseLength(embedding, "ColorHistogramEmbedder");
	return embedding;
}

}  // namespace semloop
