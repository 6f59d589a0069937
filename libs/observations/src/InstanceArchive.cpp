#include "InstanceArchive.h"

#include <semloop/config/Error.h>

#include <opencv2/core/cvdef.h>
#include <string>

namespace semloop
{
namespace
{
using mrpt::serialization::CArchive;

// A damaged count must not make us ask for all the memory there is.
constexpr uint32_t kMostLabels = 1u << 20;
constexpr uint32_t kLongestName = 1u << 12;
constexpr uint32_t kMostInstances = 1u << 16;
constexpr uint32_t kLongestEmbedding = 1u << 16;
constexpr uint32_t kMostRuns = 1u << 24;

uint32_t readCount(CArchive& in, uint32_t most, const char* what)
{
	const auto count = in.ReadAs<uint32_t>();
	if (count > most)
		throw InputError("damaged: " + std::to_string(count) + " " + what + " in an observation");
	return count;
}

void writeWords(CArchive& out, const std::vector<uint16_t>& words)
{
	out.WriteAs<uint32_t>(words.size());
	if (!words.empty()) out.WriteBufferFixEndianness(words.data(), words.size());
}

std::vector<uint16_t> readWords(CArchive& in, uint32_t most, const char* what)
{
	std::vector<uint16_t> words(readCount(in, most, what));
	if (!words.empty()) in.ReadBufferFixEndianness(words.data(), words.size());
	return words;
}

void writeEmbedding(CArchive& out, const std::vector<float>& embedding)
{
	std::vector<uint16_t> halves;
	halves.reserve(embedding.size());
	for (const float value : embedding) halves.push_back(cv::float16_t(value).bits());
	writeWords(out, halves);
}

std::vector<float> readEmbedding(CArchive& in)
{
	std::vector<float> embedding;
	for (const uint16_t bits : readWords(in, kLongestEmbedding, "numbers in an embedding"))
		embedding.push_back(float(cv::float16_t::fromBits(bits)));
	return embedding;
}

void writeMask(CArchive& out, const InstanceMask& mask)
{
	std::vector<uint16_t> words;
	words.reserve(3 * mask.runs().size());
	for (const auto& run : mask.runs()) words.insert(words.end(), {run.row, run.begin, run.end});
	writeWords(out, words);
}

InstanceMask readMask(CArchive& in, cv::Size imageSize)
{
	const auto words = readWords(in, 3 * kMostRuns, "numbers in a mask");
	if (words.size() % 3 != 0) throw InputError("damaged: a mask's last run is not whole");
	std::vector<InstanceMask::Run> runs;
	runs.reserve(words.size() / 3);
	for (std::size_t i = 0; i < words.size(); i += 3)
		runs.push_back({words[i], words[i + 1], words[i + 2]});
	return InstanceMask(imageSize, std::move(runs));
}

void writeDepth(CArchive& out, const std::optional<DepthCrop>& crop)
{
	out << crop.has_value();
	if (!crop) return;
	out << crop->unit;
	const cv::Mat depth = crop->depth.isContinuous() ? crop->depth : crop->depth.clone();
	out.WriteBufferFixEndianness(depth.ptr<uint16_t>(), depth.total());
}

/** Whether an optional part follows. A damaged byte must not become a bool. */
bool readIsThere(CArchive& in)
{
	const auto byte = in.ReadAs<uint8_t>();
	if (byte > 1)
		throw InputError("damaged: neither yes nor no where an instance's parts are announced");
	return byte == 1;
}

std::optional<DepthCrop> readDepth(CArchive& in, cv::Size size)
{
	if (!readIsThere(in)) return std::nullopt;
	DepthCrop crop;
	in >> crop.unit;
	crop.depth.create(size, CV_16UC1);
	in.ReadBufferFixEndianness(crop.depth.ptr<uint16_t>(), crop.depth.total());
	return crop;
}

void writeTrueObject(CArchive& out, const std::optional<uint32_t>& trueObject)
{
	out << trueObject.has_value();
	if (trueObject) out << *trueObject;
}

std::optional<uint32_t> readTrueObject(CArchive& in)
{
	if (!readIsThere(in)) return std::nullopt;
	return in.ReadAs<uint32_t>();
}

void writeInstance(CArchive& out, const Instance& instance)
{
	for (const int side : {instance.box.x, instance.box.y, instance.box.width, instance.box.height})
		out.WriteAs<uint16_t>(side);
	out << instance.confidence;
	out.WriteAs<uint32_t>(instance.labelScores.size());
	for (const auto& score : instance.labelScores) out << score.label << score.score;
	writeEmbedding(out, instance.embedding);
	writeMask(out, instance.mask);
	writeDepth(out, instance.depth);
	writeTrueObject(out, instance.trueObject);
}

Instance readInstance(CArchive& in, cv::Size imageSize, uint8_t version)
{
	Instance instance;
	for (int* const side :
		 {&instance.box.x, &instance.box.y, &instance.box.width, &instance.box.height})
		*side = in.ReadAs<uint16_t>();
	in >> instance.confidence;
	instance.labelScores.resize(readCount(in, kMostLabels, "label scores"));
	for (auto& score : instance.labelScores) in >> score.label >> score.score;
	instance.embedding = readEmbedding(in);
	instance.mask = readMask(in, imageSize);
	instance.depth = readDepth(in, instance.box.size());
	if (version >= 1) instance.trueObject = readTrueObject(in);
	return instance;
}

}  // namespace

void writeLabels(CArchive& out, const LabelSet& labels)
{
	out.WriteAs<uint32_t>(labels.size());
	for (const auto& name : labels.names()) out << name;
}

LabelSet readLabels(CArchive& in)
{
	std::vector<std::string> names(readCount(in, kMostLabels, "labels"));
	for (auto& name : names)
	{
		name.resize(readCount(in, kLongestName, "letters in a label"));
		if (!name.empty()) in.ReadBuffer(name.data(), name.size());
	}
	return LabelSet(std::move(names));
}

void writeInstances(CArchive& out, const std::vector<Instance>& instances)
{
	out.WriteAs<uint32_t>(instances.size());
	for (const auto& instance : instances) writeInstance(out, instance);
}

std::vector<Instance> readInstances(CArchive& in, cv::Size imageSize, uint8_t version)
{
	std::vector<Instance> instances;
	const uint32_t count = readCount(in, kMostInstances, "instances");
	for (uint32_t i = 0; i < count; i++) instances.push_back(readInstance(in, imageSize, version));
	return instances;
}

}  // namespace semloop
