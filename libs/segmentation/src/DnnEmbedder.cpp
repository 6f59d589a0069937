#include "DnnNetwork.h"
#include "MaskedCrop.h"

#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/DnnEmbedder.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace semloop
{
IMPLEMENTS_MRPT_OBJECT(DnnEmbedder, Embedder, semloop)

namespace
{
MRPT_INITIALIZER(registerDnnEmbedder)
{
	mrpt::rtti::registerClass(CLASS_ID(DnnEmbedder));
}

/** A vector has one dimension that is not 1. */
bool isVector(const cv::Mat& output)
{
	int longest = 0;
	for (int d = 0; d < output.dims; d++) longest = std::max(longest, output.size[d]);
	return output.type() == CV_32F && longest > 1 && output.total() == std::size_t(longest);
}
}  // namespace

struct DnnEmbedder::State
{
	explicit State(const DnnEmbedderOptions& o)
		: options(o), network(o.model, "", {o.inputWidth, o.inputHeight})
	{
		const auto& outputs = network.trialOutputs();
		if (outputs.size() != 1 || !isVector(outputs.front()))
			throw InputError(
				network.path() +
				": not an embedding network, which has one vector as output (its " +
				"outputs: " + network.describe(outputs) + "); see doc/segmentation-networks.md");
	}

	DnnEmbedderOptions options;
	DnnNetwork network;
};

void DnnEmbedderOptions::describe(OptionFields& fields)
{
	fields.text("model", model, "network file (.onnx): colour image -> one vector");
	fields.integer(
		"input_width", inputWidth, 0, 8192,
		"width of the network's input [px]; 0: as the file says");
	fields.integer(
		"input_height", inputHeight, 0, 8192,
		"height of the network's input [px]; 0: as the file says");
	fields.number(
		"mean", mean, 0, 255,
		"subtracted from every pixel value; also the colour of the background");
	fields.number("scale", scale, 1e-6, 1e6, "what the difference is multiplied with");
}

DnnEmbedder::DnnEmbedder() = default;
DnnEmbedder::~DnnEmbedder() = default;

void DnnEmbedder::configure(const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	DnnEmbedderOptions options;
	options.loadFromConfigFile(config, section);
	requireModel(config, section, options.model);
	configure(options);
}

void DnnEmbedder::configure(const DnnEmbedderOptions& options)
{
	state_ = std::make_unique<State>(options);
}

std::vector<float> DnnEmbedder::embed(const cv::Mat& color, const Instance& instance)
{
	if (!state_) throw UsageError("DnnEmbedder: configure() was not called");
	if (instance.mask.empty()) return {};
	const MaskedCrop crop = maskedCrop(color, instance, "DnnEmbedder");

	cv::Mat object(crop.color.size(), CV_32FC3, cv::Scalar::all(state_->options.mean));
	cv::Mat pixels;
	crop.color.convertTo(pixels, CV_32F);
	pixels.copyTo(object, crop.mask);
	cv::Mat input;
	const cv::Size size = state_->network.inputSize();
	const bool shrinks = size.area() < object.size().area();
	cv::resize(object, input, size, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);

	const cv::Mat output =
		state_->network.run(input, {state_->options.mean, state_->options.scale}).front();
	const auto* values = output.ptr<float>();
	std::vector<float> embedding(values, values + output.total());
	normaliseLength(embedding, state_->network.path());
	return embedding;
}

}  // namespace semloop
