#include <mrpt/core/initializer.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include <cmath>

namespace semloop
{
IMPLEMENTS_SERIALIZABLE(CObjectMap, CMetricMap, semloop)

MRPT_INITIALIZER(registerObjectMap)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::CObjectMap));
}

namespace
{
using mrpt::poses::CPose3D;
using mrpt::serialization::CArchive;

// More than any real map has: a damaged count must not allocate gigabytes.
constexpr uint32_t kLongestName = 4096, kMostLabels = 1000000;
constexpr uint32_t kMostEmbeddings = 100000, kLongestEmbedding = 65536;

[[noreturn]] void damaged(const std::string& what)
{
	throw InputError("object map: " + what + ": the file is damaged, write it again");
}

/** Zero first: the archive leaves the rest of a value as it was when the file ends within it. */
template <class Number>
Number readNumber(CArchive& in)
{
	Number value = 0;
	in >> value;
	return value;
}

uint32_t readCount(CArchive& in, uint32_t maximum, const char* what)
{
	const auto count = readNumber<uint32_t>(in);
	if (count > maximum) damaged(std::to_string(count) + " " + what);
	return count;
}

void writeText(CArchive& out, const std::string& text)
{
	out << uint32_t(text.size());
	for (const char c : text) out << uint8_t(c);
}

std::string readText(CArchive& in)
{
	std::string text;
	const uint32_t size = readCount(in, kLongestName, "characters in a name");
	for (uint32_t i = 0; i < size; ++i) text += char(readNumber<uint8_t>(in));
	return text;
}

/** By key, so that options may come and go. */
/** Options of a map are numbers and flags; they are written as double. */
struct NumberOf
{
	template <class Value>
	double operator()(const Value* value) const
	{
		if constexpr (std::is_arithmetic_v<Value>) return double(*value);
		throw std::logic_error("an option of a map that is no number");
	}
};

struct SetNumber
{
	double number;

	template <class Value>
	void operator()(Value* value) const
	{
		if constexpr (std::is_same_v<Value, bool>)
			*value = number != 0;
		else if constexpr (std::is_arithmetic_v<Value>)
			*value = Value(number);
	}
};

void writeOptions(CArchive& out, const Options& options)
{
	const auto fields = options.fields();
	out << uint32_t(fields.size());
	for (const auto& field : fields)
	{
		writeText(out, field.key);
		out << std::visit(NumberOf(), field.target);
	}
}

void readOptions(CArchive& in, Options& options)
{
	const auto fields = options.fields();
	const uint32_t count = readCount(in, 1000, "options");
	for (uint32_t i = 0; i < count; ++i)
	{
		const std::string key = readText(in);
		const auto value = readNumber<double>(in);
		for (const auto& field : fields)
		{
			if (field.key != key) continue;
			if (!(value >= field.minimum && value <= field.maximum))
				damaged(key + " = " + std::to_string(value) + " is out of range");
			std::visit(SetNumber{value}, field.target);
		}
	}
}

void writePose(CArchive& out, const CPose3D& pose)
{
	out << pose.x() << pose.y() << pose.z();
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column) out << pose.getRotationMatrix()(row, column);
}

CPose3D readPose(CArchive& in)
{
	mrpt::math::CMatrixDouble31 translation;
	mrpt::math::CMatrixDouble33 rotation;
	for (int row = 0; row < 3; ++row) translation(row, 0) = readNumber<double>(in);
	for (int row = 0; row < 3; ++row)
		for (int column = 0; column < 3; ++column) rotation(row, column) = readNumber<double>(in);
	const auto R = rotation.asEigen();
	const double skew = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm();
	if (!(skew < 1e-6 && R.determinant() > 0) || !translation.asEigen().allFinite())
		damaged("a pose is not one");
	return CPose3D(rotation, translation);
}

void writeTime(CArchive& out, mrpt::Clock::time_point time)
{
	out << int64_t(time.time_since_epoch().count());
}

mrpt::Clock::time_point readTime(CArchive& in)
{
	return mrpt::Clock::time_point(mrpt::Clock::duration(readNumber<int64_t>(in)));
}

void writeObject(CArchive& out, const Object& object)
{
	out << object.id;
	writePose(out, object.T_world_object);
	object.volume->serializeTo(out);
	out << uint32_t(object.labelScores.size());
	for (const auto& score : object.labelScores) out << score.label << score.score;
	out << uint32_t(object.embeddings.size());
	for (const auto& embedding : object.embeddings)
	{
		out << uint32_t(embedding.size());
		for (const float value : embedding) out << value;
	}
	out << int32_t(object.observations) << int32_t(object.timesSeenThrough) << object.existence;
	out << uint32_t(object.covisible.size());
	for (const auto& [id, count] : object.covisible) out << id << int32_t(count);
	writeTime(out, object.firstSeen);
	writeTime(out, object.lastSeen);
	out << uint8_t(object.seenSides.bits());
}

LabelScores readLabelScores(CArchive& in, std::size_t labels)
{
	LabelScores scores(readCount(in, kMostLabels, "label scores"));
	if (scores.empty()) damaged("an object without a label");
	for (auto& score : scores)
	{
		in >> score.label >> score.score;
		if (score.label >= labels || !(score.score >= 0 && score.score <= 1))
			damaged("label " + std::to_string(score.label) + " of " + std::to_string(labels));
	}
	return scores;
}

std::vector<std::vector<float>> readEmbeddings(CArchive& in)
{
	std::vector<std::vector<float>> embeddings(readCount(in, kMostEmbeddings, "embeddings"));
	for (auto& embedding : embeddings)
	{
		embedding.resize(readCount(in, kLongestEmbedding, "numbers in an embedding"));
		for (float& value : embedding)
		{
			in >> value;
			if (!std::isfinite(value)) damaged("an embedding is not finite");
		}
	}
	return embeddings;
}

constexpr uint8_t kAllSides = (1U << SeenSides::kSides) - 1;

Object readObject(CArchive& in, std::size_t labels, uint8_t version)
{
	Object object;
	object.id = readNumber<uint64_t>(in);
	object.T_world_object = readPose(in);
	object.volume = std::make_shared<TsdfVolume>();
	object.volume->serializeFrom(in);
	object.labelScores = readLabelScores(in, labels);
	object.embeddings = readEmbeddings(in);
	object.observations = readNumber<int32_t>(in);
	object.timesSeenThrough = readNumber<int32_t>(in);
	object.existence = readNumber<double>(in);
	if (object.observations < 1 || object.timesSeenThrough < 0 ||
		!(object.existence >= 0 && object.existence <= 1))
		damaged("object " + std::to_string(object.id) + " has impossible counts");
	const auto neighbours = readNumber<uint32_t>(in);
	for (uint32_t i = 0; i < neighbours; ++i)
	{
		const auto id = readNumber<uint64_t>(in);
		object.covisible[id] = readNumber<int32_t>(in);
	}
	object.firstSeen = readTime(in);
	object.lastSeen = readTime(in);
	// Before, it was not kept: what may have been seen is not held against an object.
	const auto sides = version >= 2 ? readNumber<uint8_t>(in) : kAllSides;
	if (sides > kAllSides) damaged("object " + std::to_string(object.id) + " has too many sides");
	object.seenSides = SeenSides(sides);
	return object;
}
}  // namespace

uint8_t CObjectMap::serializeGetVersion() const
{
	return 2;  // 1: options of likelihood and visualization; 2: seen sides
}

void CObjectMap::serializeTo(CArchive& out) const
{
	out << genericMapParams.enableSaveAs3DObject << genericMapParams.enableObservationLikelihood
		<< genericMapParams.enableObservationInsertion;
	writeOptions(out, insertionOptions);
	writeOptions(out, maintenanceOptions);
	writeOptions(out, likelihoodOptions);
	writeOptions(out, visualizationOptions);
	out << uint32_t(labels_.size());
	for (const auto& name : labels_.names()) writeText(out, name);
	out << nextId_ << uint32_t(objects_.size());
	for (const auto& [id, object] : objects_) writeObject(out, object);
}

void CObjectMap::serializeFrom(CArchive& in, uint8_t version)
{
	if (version > 2) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
	CObjectMap map;  // so that nothing is half read when this throws
	map.genericMapParams.enableSaveAs3DObject = readNumber<uint8_t>(in) != 0;
	map.genericMapParams.enableObservationLikelihood = readNumber<uint8_t>(in) != 0;
	map.genericMapParams.enableObservationInsertion = readNumber<uint8_t>(in) != 0;
	readOptions(in, map.insertionOptions);
	readOptions(in, map.maintenanceOptions);
	if (version >= 1)
	{
		readOptions(in, map.likelihoodOptions);
		readOptions(in, map.visualizationOptions);
	}
	std::vector<std::string> labels(readCount(in, kMostLabels, "labels"));
	for (auto& label : labels) label = readText(in);
	map.labels_ = LabelSet(std::move(labels));
	map.nextId_ = readNumber<uint64_t>(in);
	const auto count = readNumber<uint32_t>(in);
	for (uint32_t i = 0; i < count; ++i)
	{
		Object object = readObject(in, map.labels_.size(), version);
		const ObjectId id = object.id;
		if (id >= map.nextId_ || !map.objects_.emplace(id, std::move(object)).second)
			damaged("id " + std::to_string(id) + " is repeated or out of range");
	}
	for (const auto& [id, object] : map.objects_)
		for (const auto& [other, times] : object.covisible)
			if (other == id || times < 1 || map.objects_.count(other) == 0)
				damaged("object " + std::to_string(id) + " was seen with one that is not there");
	*this = std::move(map);
}

}  // namespace semloop
