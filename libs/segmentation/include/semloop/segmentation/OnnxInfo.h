#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** What an ONNX file says about itself. */
struct OnnxInfo
{
	std::vector<int64_t> inputShape;  //!< of the first input, [1, 3, height, width]; -1 = left open
	int64_t opset = 0;                //!< version of the operators; 0 = not said
};

/** Reads the head data of a model's graph (cv::dnn has them but does not show them); empty when the
 *  bytes are not an ONNX model with a graph and an input. */
std::optional<OnnxInfo> parseOnnxInfo(const std::string& bytes);

/** Same, of a file; empty also when it cannot be read. */
std::optional<OnnxInfo> readOnnxInfo(const std::string& path);

}  // namespace semloop
