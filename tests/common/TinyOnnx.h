#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace semloop::test
{
/** An output of a tiny network: bias + weights . (mean R, mean G, mean B), in the given shape. */
struct TinyOutput
{
	std::string name;
	std::vector<int64_t> shape;
	std::vector<float> bias;
	std::vector<float> weights = {};  //!< three for each value; empty: the output is constant
};

/** Writes Protocol Buffers messages. */
class ProtoWriter
{
public:
	ProtoWriter& number(uint64_t field, uint64_t value)
	{
		varint(field << 3);
		varint(value);
		return *this;
	}
	ProtoWriter& bytes(uint64_t field, const std::string& value)
	{
		varint(field << 3 | 2);
		varint(value.size());
		bytes_ += value;
		return *this;
	}
	ProtoWriter& message(uint64_t field, const ProtoWriter& value)
	{
		return bytes(field, value.bytes_);
	}
	const std::string& str() const { return bytes_; }

private:
	void varint(uint64_t value)
	{
		for (; value >= 0x80; value >>= 7) bytes_ += char(value | 0x80);
		bytes_ += char(value);
	}

	std::string bytes_;
};

namespace onnx
{
template <class T>
ProtoWriter tensor(
	const std::string& name, int type, const std::vector<int64_t>& shape,
	const std::vector<T>& values)
{
	ProtoWriter writer;
	for (const auto size : shape) writer.number(1, uint64_t(size));
	std::string raw(values.size() * sizeof(T), '\0');
	std::memcpy(raw.data(), values.data(), raw.size());
	return writer.number(2, uint64_t(type)).bytes(8, name).bytes(9, raw);
}

inline ProtoWriter node(
	const std::string& type, const std::vector<std::string>& inputs, const std::string& output)
{
	ProtoWriter writer;
	for (const auto& input : inputs) writer.bytes(1, input);
	return writer.bytes(2, output).bytes(3, type + "_" + output).bytes(4, type);
}

inline ProtoWriter integers(const std::string& name, const std::vector<uint64_t>& values)
{
	ProtoWriter writer;
	writer.bytes(1, name);
	for (const auto v : values) writer.number(8, v);
	return writer.number(20, 7);
}

/** Sizes below 0 are left open. */
inline ProtoWriter value(const std::string& name, const std::vector<int64_t>& shape)
{
	ProtoWriter dimensions;
	for (const auto size : shape)
		dimensions.message(
			1, size < 0 ? ProtoWriter().bytes(2, "open") : ProtoWriter().number(1, uint64_t(size)));
	const auto tensorType = ProtoWriter().number(1, 1).message(2, dimensions);
	return ProtoWriter().bytes(1, name).message(2, ProtoWriter().message(1, tensorType));
}
}  // namespace onnx

/** The bytes of an ONNX network of a few kilobytes, for tests that need no trained one. */
inline std::string tinyOnnx(
	const std::vector<int64_t>& inputShape, const std::vector<TinyOutput>& outputs, int opset = 10)
{
	ProtoWriter graph;
	graph.bytes(2, "tiny");
	graph.message(1, onnx::node("GlobalAveragePool", {"image"}, "mean"));
	for (const auto& output : outputs)
	{
		const auto count = int64_t(output.bias.size());
		const auto weights =
			output.weights.empty() ? std::vector<float>(output.bias.size() * 3) : output.weights;
		const auto& n = output.name;
		graph.message(5, onnx::tensor(n + "_weights", 1, {count, 3, 1, 1}, weights));
		graph.message(5, onnx::tensor(n + "_bias", 1, {count}, output.bias));
		graph.message(
			5, onnx::tensor(n + "_shape", 7, {int64_t(output.shape.size())}, output.shape));
		auto convolution = onnx::node("Conv", {"mean", n + "_weights", n + "_bias"}, n + "_flat");
		graph.message(1, convolution.message(5, onnx::integers("kernel_shape", {1, 1})));
		graph.message(1, onnx::node("Reshape", {n + "_flat", n + "_shape"}, n));
		graph.message(12, onnx::value(n, output.shape));
	}
	graph.message(11, onnx::value("image", inputShape));
	return ProtoWriter()
		.number(1, 5)
		.message(8, ProtoWriter().number(2, uint64_t(opset)))
		.message(7, graph)
		.str();
}

inline void writeFile(const std::string& path, const std::string& bytes)
{
	std::ofstream(path, std::ios::binary) << bytes;
}

/** A YOLO-seg network for images of 64 x 32 with two labels and one mask prototype, that always sees:
 *  label 0 in [8, 24) x [8, 24) with 0.9 (0.3 for label 1), label 1 in [40, 56) x [4, 28) with 0.6. The
 *  prototype is positive in the left three quarters (x < 48) and negative to the right. */
inline std::string tinyYoloSeg()
{
	constexpr int kCandidates = 32 + 8 + 2, kChannels = 4 + 2 + 1;
	std::vector<float> predictions(kChannels * kCandidates);
	const auto set = [&](int column, const std::vector<float>& values)
	{
		for (std::size_t c = 0; c < values.size(); c++)
			predictions[c * kCandidates + std::size_t(column)] = values[c];
	};
	set(3, {16, 16, 16, 16, 0.9f, 0.3f, 1});
	set(4, {17, 16, 16, 16, 0.8f, 0.1f, 1});  // the same object again, a little off
	set(20, {48, 16, 16, 24, 0.01f, 0.6f, 1});
	set(30, {48, 16, 16, 24, 0.2f, 0.1f, 1});  // below every threshold in use
	std::vector<float> prototype;
	for (int y = 0; y < 8; y++)
		for (int x = 0; x < 16; x++) prototype.push_back(x < 12 ? 5.0f : -5.0f);
	return tinyOnnx(
		{1, 3, 32, 64}, {{"output0", {1, kChannels, kCandidates}, predictions},
						 {"output1", {1, 1, 8, 16}, prototype}});
}

/** An embedding network for images of 8 x 8: the three mean colours. */
inline std::string tinyEmbedding()
{
	return tinyOnnx({1, 3, 8, 8}, {{"feature", {1, 3}, {0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}});
}

}  // namespace semloop::test
