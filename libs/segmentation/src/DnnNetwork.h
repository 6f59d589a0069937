#pragma once

#include <mrpt/config/CConfigFileBase.h>

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

namespace semloop
{
/** How an image becomes a network's input: (pixel - mean) * scale, RGB. */
struct InputScaling
{
	double mean = 0.0;
	double scale = 1.0;
};

/** Throws UsageError when a configuration's section does not name a network. */
void requireModel(
	const mrpt::config::CConfigFileBase& config, const std::string& section,
	const std::string& model);

/** A network in cv::dnn that has shown that it runs. */
class DnnNetwork
{
public:
	/** Loads it and runs it once on an empty image.
	 *  @param configPath the .pbtxt of a TensorFlow graph, else empty
	 *  @param wantedSize of the input; 0 x 0: as the ONNX file says
	 *  Throws InputError naming the file, what was found and the remedy. */
	DnnNetwork(const std::string& path, const std::string& configPath, cv::Size wantedSize);

	/** Outputs for a BGR image of inputSize(), CV_8UC3 or CV_32FC3; valid until the next call. */
	std::vector<cv::Mat> run(const cv::Mat& image, const InputScaling& scaling);

	cv::Size inputSize() const { return inputSize_; }
	/** Outputs for the empty image, for their shapes. */
	const std::vector<cv::Mat>& trialOutputs() const { return trialOutputs_; }
	const std::string& path() const { return path_; }
	/** Names and shapes, for messages: "output0 1x116x6300, output1 1x32x120x160". */
	std::string describe(const std::vector<cv::Mat>& outputs) const;

private:
	void load(const std::string& configPath);
	std::vector<cv::Mat> forward(const cv::Mat& image, const InputScaling& scaling);

	std::string path_;
	cv::Size inputSize_;
	cv::dnn::Net net_;
	std::vector<std::string> outputNames_;
	std::vector<cv::Mat> trialOutputs_;
};

}  // namespace semloop
