#include <semloop/segmentation/OnnxInfo.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string_view>

namespace semloop
{
namespace
{
/** Walks the fields of a Protocol Buffers message. */
class MessageReader
{
public:
	explicit MessageReader(std::string_view bytes) : bytes_(bytes) {}

	/** False at the end and on damaged bytes; tell them apart with ok(). */
	bool next()
	{
		if (bytes_.empty()) return false;
		const auto key = varint();
		field_ = key >> 3;
		payload_ = {};
		number_ = 0;
		switch (key & 7)
		{
			case 0:
				number_ = varint();
				break;
			case 1:
				skip(8);
				break;
			case 2:
				payload_ = take(varint());
				break;
			case 5:
				skip(4);
				break;
			default:
				ok_ = false;
		}
		return ok_;
	}

	uint64_t field() const { return field_; }
	uint64_t number() const { return number_; }
	std::string_view payload() const { return payload_; }
	bool ok() const { return ok_; }

private:
	uint64_t varint()
	{
		uint64_t value = 0;
		for (int shift = 0; shift < 64 && !bytes_.empty(); shift += 7)
		{
			const auto byte = static_cast<unsigned char>(bytes_.front());
			bytes_.remove_prefix(1);
			value |= uint64_t(byte & 0x7f) << shift;
			if (!(byte & 0x80)) return value;
		}
		ok_ = false;
		return 0;
	}

	std::string_view take(uint64_t size)
	{
		if (!ok_ || size > bytes_.size())
		{
			ok_ = false;
			return {};
		}
		const auto taken = bytes_.substr(0, size);
		bytes_.remove_prefix(size);
		return taken;
	}

	void skip(uint64_t size) { take(size); }

	std::string_view bytes_;
	std::string_view payload_;
	uint64_t field_ = 0;
	uint64_t number_ = 0;
	bool ok_ = true;
};

/** Payload of the first field of that number; empty when there is none. */
std::string_view fieldOf(std::string_view message, uint64_t field)
{
	for (MessageReader reader(message); reader.next();)
		if (reader.field() == field) return reader.payload();
	return {};
}

// Field numbers below are those of onnx.proto (ModelProto, GraphProto, ValueInfoProto, ...).

std::vector<int64_t> shapeOf(std::string_view valueInfo)
{
	const auto tensorType = fieldOf(fieldOf(valueInfo, 2), 1);
	std::vector<int64_t> shape;
	for (MessageReader dimensions(fieldOf(tensorType, 2)); dimensions.next();)
	{
		if (dimensions.field() != 1) continue;
		int64_t size = -1;
		for (MessageReader dimension(dimensions.payload()); dimension.next();)
			if (dimension.field() == 1) size = int64_t(dimension.number());
		shape.push_back(size);
	}
	return shape;
}

/** The first input that is not a weight (old exporters list those as inputs too). */
std::optional<std::string_view> firstInput(std::string_view graph)
{
	std::set<std::string_view> weights;
	for (MessageReader reader(graph); reader.next();)
		if (reader.field() == 5) weights.insert(fieldOf(reader.payload(), 8));
	for (MessageReader reader(graph); reader.next();)
		if (reader.field() == 11 && weights.count(fieldOf(reader.payload(), 1)) == 0)
			return reader.payload();
	return std::nullopt;
}
}  // namespace

std::optional<OnnxInfo> parseOnnxInfo(const std::string& bytes)
{
	OnnxInfo info;
	std::optional<std::string_view> input;
	MessageReader model(bytes);
	while (model.next())
	{
		if (model.field() == 7) input = firstInput(model.payload());
		if (model.field() != 8 || !fieldOf(model.payload(), 1).empty()) continue;
		for (MessageReader opset(model.payload()); opset.next();)
			if (opset.field() == 2) info.opset = int64_t(opset.number());
	}
	if (!model.ok() || !input) return std::nullopt;
	info.inputShape = shapeOf(*input);
	return info;
}

std::optional<OnnxInfo> readOnnxInfo(const std::string& path)
{
	std::ifstream file(path, std::ios::binary);
	if (!file) return std::nullopt;
	return parseOnnxInfo({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

}  // namespace semloop
