#pragma once

#include <semloop/config/Options.h>
#include <semloop/segmentation/Embedder.h>

#include <string>

namespace semloop
{
struct ColorHistogramEmbedderOptions : Options
{
	int lightnessBins = 4;
	int colorBins = 10;
	double maxChroma = 80.0;

protected:
	void describe(OptionFields& fields) override;
};

/** Colours without a network: a histogram over CIE L*a*b* of the mask's pixels, each pixel shared
 *  trilinearly between the neighbouring bins, and its square root taken, so that the inner product of
 *  two is the Bhattacharyya coefficient of the histograms, and the length is 1. */
class ColorHistogramEmbedder : public Embedder
{
	DEFINE_MRPT_OBJECT(ColorHistogramEmbedder, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void configure(const ColorHistogramEmbedderOptions& options) { options_ = options; }

	/** lightnessBins x colorBins x colorBins values. Throws InputError when the image and the mask
	 *  differ in size. */
	std::vector<float> embed(const cv::Mat& color, const Instance& instance) override;

private:
	ColorHistogramEmbedderOptions options_;
};

}  // namespace semloop
