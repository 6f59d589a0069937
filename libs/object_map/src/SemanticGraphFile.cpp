#include <semloop/config/Error.h>
#include <semloop/object_map/SemanticGraph.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace semloop
{
namespace
{
using nlohmann::json;

constexpr const char* kFormat = "semloop.graph/1";
constexpr double kUnitLengthTolerance = 0.01;  // files are rounded to a few digits
constexpr double kQuaternionTolerance = 4e-4;  // MRPT refuses more

/** A value of the document and where it stands, so that every error can name its place. */
class Node
{
public:
	Node(const json& value, const std::string& file, std::string place = {})
		: value_(value), file_(file), place_(std::move(place))
	{
	}

	[[noreturn]] void fail(const std::string& problem) const
	{
		throw InputError(file_ + ": " + (place_.empty() ? "document" : place_) + ": " + problem);
	}

	Node at(std::size_t i) const
	{
		return {value_[i], file_, place_ + "[" + std::to_string(i) + "]"};
	}

	bool has(const std::string& key) const { return value_.contains(key); }

	Node at(const std::string& key) const
	{
		if (!value_.is_object()) fail("must be an object {...}");
		if (!has(key)) fail("\"" + key + "\" is missing");
		return {value_[key], file_, place_.empty() ? key : place_ + "." + key};
	}

	std::size_t arraySize() const
	{
		if (!value_.is_array()) fail("must be an array [...]");
		return value_.size();
	}

	std::string text() const
	{
		if (!value_.is_string() || value_.get_ref<const std::string&>().empty())
			fail("must be a text that is not empty, is " + value_.dump());
		return value_;
	}

	double number() const
	{
		if (!value_.is_number() || !std::isfinite(value_.get<double>()))
			fail("must be a finite number, is " + value_.dump());
		return value_;
	}

	uint64_t index() const
	{
		if (!value_.is_number_unsigned()) fail("must be an integer >= 0, is " + value_.dump());
		return value_;
	}

	const json& value() const { return value_; }

private:
	const json& value_;
	const std::string& file_;
	std::string place_;
};

mrpt::math::TPoint3D parsePoint(const Node& node)
{
	if (node.arraySize() != 3) node.fail("must have 3 numbers");
	return {node.at(0).number(), node.at(1).number(), node.at(2).number()};
}

std::vector<float> parseEmbedding(const Node& node)
{
	std::vector<float> embedding(node.arraySize());
	double squared = 0;
	for (std::size_t i = 0; i < embedding.size(); ++i)
	{
		embedding[i] = static_cast<float>(node.at(i).number());
		squared += static_cast<double>(embedding[i]) * embedding[i];
	}
	if (std::abs(std::sqrt(squared) - 1.0) > kUnitLengthTolerance)
		node.fail("length is " + std::to_string(std::sqrt(squared)) + ", must be 1: normalise it");
	return embedding;
}

mrpt::math::CQuaternionDouble parseQuaternion(const Node& node)
{
	if (node.arraySize() != 4) node.fail("must have 4 numbers, qx, qy, qz, qw");
	const double x = node.at(0).number(), y = node.at(1).number(), z = node.at(2).number(),
				 w = node.at(3).number();
	const double length = std::hypot(std::hypot(x, y, z), w);
	if (std::abs(length - 1.0) > kQuaternionTolerance)
		node.fail("length is " + std::to_string(length) + ", must be 1: normalise it");
	return {w, x, y, z};
}

std::map<std::string, double> parseScores(const Node& node)
{
	if (!node.value().is_object()) node.fail("must be an object {label: score}");
	std::map<std::string, double> scores;
	for (const auto& [label, unused] : node.value().items())
	{
		const double score = node.at(label).number();
		if (score < 0 || score > 1) node.at(label).fail("must be in [0, 1]");
		scores[label] = score;
	}
	return scores;
}

GraphVertex parseVertex(const Node& node)
{
	GraphVertex vertex;
	vertex.id = node.at("id").index();
	vertex.label = node.at("label").text();
	vertex.position = parsePoint(node.at("position"));
	if (node.has("label_scores")) vertex.labelScores = parseScores(node.at("label_scores"));
	if (node.has("embedding")) vertex.embeddings = {parseEmbedding(node.at("embedding"))};
	if (node.has("extent"))
	{
		const auto extent = parsePoint(node.at("extent"));
		if (extent.x < 0 || extent.y < 0 || extent.z < 0)
			node.at("extent").fail("must not be negative");
		vertex.extent.emplace(extent.x, extent.y, extent.z);
	}
	if (node.has("orientation")) vertex.orientation = parseQuaternion(node.at("orientation"));
	if (node.has("completeness"))
	{
		vertex.completeness = node.at("completeness").number();
		if (*vertex.completeness < 0 || *vertex.completeness > 1)
			node.at("completeness").fail("must be in [0, 1]");
	}
	if (node.has("observations"))
	{
		const uint64_t count = node.at("observations").index();
		if (count > uint64_t(std::numeric_limits<int>::max()))
			node.at("observations").fail("is too large");
		vertex.observations = static_cast<int>(count);
	}
	return vertex;
}

using IndexOfId = std::map<ObjectId, std::size_t>;

IndexOfId parseVertices(const Node& objects, SemanticGraph& graph)
{
	IndexOfId indexOf;
	std::optional<std::size_t> embeddingSize;
	for (std::size_t i = 0; i < objects.arraySize(); ++i)
	{
		const Node node = objects.at(i);
		graph.vertices.push_back(parseVertex(node));
		const auto& vertex = graph.vertices.back();
		if (const auto [first, isNew] = indexOf.emplace(vertex.id, i); !isNew)
			node.at("id").fail(
				std::to_string(vertex.id) + " is already the id of objects[" +
				std::to_string(first->second) + "]: ids must be unique");
		if (vertex.embeddings.empty()) continue;
		const std::size_t size = vertex.embeddings.front().size();
		if (size != embeddingSize.value_or(size))
			node.at("embedding")
				.fail(
					"has " + std::to_string(size) + " numbers, the ones before have " +
					std::to_string(*embeddingSize) + ": use one network for all objects");
		embeddingSize = size;
	}
	return indexOf;
}

void parseEdges(const Node& edges, const IndexOfId& indexOf, SemanticGraph& graph)
{
	const auto find = [&](const Node& id)
	{
		const auto found = indexOf.find(id.index());
		if (found == indexOf.end()) id.fail("no object has the id " + id.value().dump());
		return found->second;
	};
	for (std::size_t i = 0; i < edges.arraySize(); ++i)
	{
		const Node edge = edges.at(i);
		if (edge.arraySize() != 2) edge.fail("must be a pair of ids [a, b]");
		const std::size_t a = find(edge.at(0)), b = find(edge.at(1));
		if (a == b) edge.fail("joins object " + edge.at(0).value().dump() + " to itself");
		graph.edges.insert(std::minmax(a, b));
	}
}

json parseFile(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be opened; does it exist?");
	try
	{
		return json::parse(file);
	}
	catch (const json::exception& error)
	{
		throw InputError(path + ": is not valid JSON: " + error.what());
	}
}

/** Rounded to micrometres (or millionths): the same graph gives the same bytes. */
double rounded(double value, const std::string& path, const GraphVertex& vertex)
{
	if (!std::isfinite(value))
		throw InputError(
			path + ": object " + std::to_string(vertex.id) +
			" has a number that is not finite: nothing was written");
	return std::round(value * 1e6) / 1e6 + 0.0;  // + 0.0: no negative zero
}

/** The direction of the mean; empty when the vertex has no embedding or they cancel out. */
std::vector<float> meanEmbedding(const GraphVertex& vertex)
{
	if (vertex.embeddings.size() == 1) return vertex.embeddings.front();
	std::vector<double> sum;
	for (const auto& embedding : vertex.embeddings)
	{
		sum.resize(std::max(sum.size(), embedding.size()));
		for (std::size_t i = 0; i < embedding.size(); ++i) sum[i] += embedding[i];
	}
	double squared = 0;
	for (const double value : sum) squared += value * value;
	if (squared < 1e-12) return {};
	std::vector<float> mean;
	for (const double value : sum) mean.push_back(static_cast<float>(value / std::sqrt(squared)));
	return mean;
}

nlohmann::ordered_json toJson(const GraphVertex& vertex, const std::string& path)
{
	const auto number = [&](double value) { return rounded(value, path, vertex); };
	nlohmann::ordered_json object;
	object["id"] = vertex.id;
	object["label"] = vertex.label;
	const auto& p = vertex.position;
	object["position"] = {number(p.x), number(p.y), number(p.z)};
	for (const auto& [label, score] : vertex.labelScores)
		object["label_scores"][label] = number(score);
	for (const float value : meanEmbedding(vertex)) object["embedding"].push_back(number(value));
	if (const auto& e = vertex.extent)
		object["extent"] = {number(e->x), number(e->y), number(e->z)};
	if (const auto& q = vertex.orientation)
		object["orientation"] = {number(q->x()), number(q->y()), number(q->z()), number(q->r())};
	if (vertex.observations > 0) object["observations"] = vertex.observations;
	if (vertex.completeness) object["completeness"] = number(*vertex.completeness);
	return object;
}
}  // namespace

SemanticGraph SemanticGraph::load(const std::string& path)
{
	const json document = parseFile(path);
	const Node root(document, path);
	if (root.at("format").text() != kFormat)
		root.at("format").fail(
			"is \"" + root.at("format").text() + "\", this program reads \"" + kFormat + "\"");
	SemanticGraph graph;
	const auto indexOf = parseVertices(root.at("objects"), graph);
	parseEdges(root.at("edges"), indexOf, graph);
	return graph;
}

void SemanticGraph::save(const std::string& path) const
{
	std::map<ObjectId, const GraphVertex*> byId;
	for (const auto& vertex : vertices)
		if (!byId.emplace(vertex.id, &vertex).second)
			throw InputError(
				path + ": two objects have the id " + std::to_string(vertex.id) +
				": nothing was written");
	std::set<std::pair<ObjectId, ObjectId>> idEdges;
	for (const auto& [a, b] : edges)
		idEdges.insert(std::minmax(vertices.at(a).id, vertices.at(b).id));

	// One object a line, so that two files can be compared by eye.
	std::string text = std::string("{\"format\": \"") + kFormat + "\",\n \"objects\": [";
	const char* separator = "\n  ";
	for (const auto& [id, vertex] : byId)
		text += std::exchange(separator, ",\n  ") + toJson(*vertex, path).dump();
	text += "],\n \"edges\": " + json(idEdges).dump() + "}\n";

	std::ofstream file(path, std::ios::binary);
	file << text;
	if (!file.flush())
		throw InputError(path + ": cannot be written; check the folder, the rights and the space");
}

}  // namespace semloop
