#pragma once

#include <semloop/config/Options.h>
#include <semloop/segmentation/Embedder.h>

#include <memory>
#include <string>

namespace semloop
{
struct DnnEmbedderOptions : Options
{
	std::string model;
	int inputWidth = 0;
	int inputHeight = 0;
	double mean = 127.5;
	double scale = 1.0 / 127.5;

protected:
	void describe(OptionFields& fields) override;
};

/** The features of an image network, run by cv::dnn: the box is cut out, pixels off the mask are set to
 *  the mean (0 for the network), the crop is stretched to the network's input, RGB, and the output is
 *  scaled to unit length. Deterministic. */
class DnnEmbedder : public Embedder
{
	DEFINE_MRPT_OBJECT(DnnEmbedder, semloop)

public:
	DnnEmbedder();
	~DnnEmbedder() override;

	/** Loads the network and runs it once on an empty image. Throws InputError, saying what was found
	 *  and what to do, when the file is missing, the network does not load, its input size is unknown
	 *  or differs from the one asked for, or its output is not one vector. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	void configure(const DnnEmbedderOptions& options);

	/** Throws InputError when the image and the mask differ in size or the network's output is not
	 *  finite or zero. */
	std::vector<float> embed(const cv::Mat& color, const Instance& instance) override;

private:
	struct State;
	std::unique_ptr<State> state_;
};

}  // namespace semloop
