#include "DnnNetwork.h"

#include <semloop/config/Error.h>
#include <semloop/config/Options.h>
#include <semloop/segmentation/OnnxInfo.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/core/utils/logger.hpp>

namespace semloop
{
namespace
{
const char* const kManual = "see doc/segmentation-networks.md";

/** OpenCV prints what it throws; the message is ours to print. */
class QuietOpenCv
{
public:
	QuietOpenCv() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
	~QuietOpenCv() { cv::utils::logging::setLogLevel(level_); }
	QuietOpenCv(const QuietOpenCv&) = delete;
	QuietOpenCv& operator=(const QuietOpenCv&) = delete;

private:
	cv::utils::logging::LogLevel level_;
};

std::string text(cv::Size size)
{
	return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void requireFile(const std::string& path, const std::string& key)
{
	if (path.empty()) throw InputError("no network given: set " + key + " to its file, " + kManual);
	if (!std::filesystem::is_regular_file(path))
		throw InputError(path + ": no such network file; correct " + key + ", " + kManual);
}

/** What OpenCV says, in one line. */
std::string reason(const cv::Exception& e)
{
	std::string line = e.err;
	std::replace(line.begin(), line.end(), '\n', ' ');
	return line.substr(0, 200);
}

cv::Size inputSizeFrom(
	const std::string& path, const std::optional<OnnxInfo>& onnx, cv::Size wanted)
{
	cv::Size fixed;
	if (onnx)
	{
		const auto& shape = onnx->inputShape;
		if (shape.size() != 4 || (shape[1] != 3 && shape[1] != -1))
			throw InputError(
				path + ": its input is not one colour image (1 x 3 x height x width); " + kManual);
		if (shape[2] > 0 && shape[3] > 0) fixed = {int(shape[3]), int(shape[2])};
	}
	if (!wanted.empty() && !fixed.empty() && wanted != fixed)
		throw InputError(
			path + ": takes images of " + text(fixed) + ", but input_width x input_height is " +
			text(wanted) + "; leave both out, or export the network for that size");
	if (wanted.empty() && fixed.empty())
		throw InputError(
			path + ": does not say the size of its input; set input_width and input_height");
	return wanted.empty() ? fixed : wanted;
}

/** Why a network from this file may have failed. */
std::string remedy(const std::optional<OnnxInfo>& onnx)
{
	if (!onnx) return std::string("is it the right file? ") + kManual;
	if (onnx->opset <= 10) return kManual;
	return "its operators are of opset " + std::to_string(onnx->opset) +
		   ": export it with opset 12 and a fixed input size (a Clip needs opset 10), " + kManual;
}
}  // namespace

void requireModel(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const std::string& model)
{
	if (model.empty())
		throw UsageError(
			configFileName(config) + ": [" + section +
			"] model: missing; name the network's file, " + kManual);
}

DnnNetwork::DnnNetwork(const std::string& path, const std::string& configPath, cv::Size wantedSize)
	: path_(path)
{
	requireFile(path, "model");
	if (!configPath.empty()) requireFile(configPath, "model_config");
	const bool isOnnx = std::filesystem::path(path).extension() == ".onnx";
	const auto onnx = isOnnx ? readOnnxInfo(path) : std::nullopt;
	if (isOnnx && !onnx)
		throw InputError(path + ": not an ONNX network, or damaged; get it again, " + kManual);
	inputSize_ = inputSizeFrom(path, onnx, wantedSize);

	const QuietOpenCv quiet;
	try
	{
		load(configPath);
	}
	catch (const cv::Exception& e)
	{
		throw InputError(path + ": OpenCV cannot load it (" + reason(e) + "); " + remedy(onnx));
	}
	try
	{
		trialOutputs_ = forward(cv::Mat::zeros(inputSize_, CV_8UC3), {});
	}
	catch (const cv::Exception& e)
	{
		throw InputError(
			path + ": does not run on an image of " + text(inputSize_) + " (" + reason(e) +
			"); correct input_width and input_height, or " + kManual);
	}
}

void DnnNetwork::load(const std::string& configPath)
{
	net_ = cv::dnn::readNet(path_, configPath);
	// OpenCV 4.6 fuses the layers of attention blocks into something that computes other numbers.
	net_.enableFusion(false);
	net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
	net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
	outputNames_ = net_.getUnconnectedOutLayersNames();
	// A Mask R-CNN goes on from its boxes to its masks: they are not an unconnected output.
	const auto layers = net_.getLayerNames();
	const std::string boxes = "detection_out_final";
	if (std::find(layers.begin(), layers.end(), boxes) != layers.end() &&
		std::find(outputNames_.begin(), outputNames_.end(), boxes) == outputNames_.end())
		outputNames_.insert(outputNames_.begin(), boxes);
}

std::vector<cv::Mat> DnnNetwork::forward(const cv::Mat& image, const InputScaling& scaling)
{
	const double mean = scaling.mean;
	net_.setInput(cv::dnn::blobFromImage(
		image, scaling.scale, inputSize_, {mean, mean, mean}, true /* to RGB */));
	std::vector<cv::Mat> outputs;
	net_.forward(outputs, outputNames_);
	return outputs;
}

std::vector<cv::Mat> DnnNetwork::run(const cv::Mat& image, const InputScaling& scaling)
{
	try
	{
		return forward(image, scaling);
	}
	catch (const cv::Exception& e)
	{
		throw InputError(path_ + ": the network failed (" + reason(e) + ")");
	}
}

std::string DnnNetwork::describe(const std::vector<cv::Mat>& outputs) const
{
	std::string all;
	for (std::size_t i = 0; i < outputs.size(); i++)
	{
		all += (i ? ", " : "") + outputNames_[i] + " ";
		for (int d = 0; d < outputs[i].dims; d++)
			all += (d ? "x" : "") + std::to_string(outputs[i].size[d]);
	}
	return all;
}

}  // namespace semloop
