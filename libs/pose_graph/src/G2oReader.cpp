#include <semloop/config/Error.h>
#include <semloop/pose_graph/PoseResidual.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "G2oRecords.h"

namespace semloop
{
namespace
{
class Reader
{
public:
	Reader(const std::string& path, PoseGraph& graph, G2oRotation rotation)
		: path_(path), graph_(graph), scale_(residualScale(rotation))
	{
	}

	void read()
	{
		std::ifstream file(path_);
		if (!file) throw InputError(path_ + ": cannot be opened; is the path right?");
		for (std::string text; std::getline(file, text);)
		{
			++line_;
			readLine(text);
		}
		if (file.bad()) throw InputError(place() + "reading failed");
		addNodes();
		addEdges();
	}

private:
	struct Vertex
	{
		uint64_t id;
		RigidTransform T;
	};
	struct Edge
	{
		int line;
		uint64_t a, b;
		PoseEdge edge;
		std::optional<PoseEdge::Kind> kind;
	};

	std::string place() const { return path_ + ":" + std::to_string(line_) + ": "; }

	void readLine(const std::string& text)
	{
		std::istringstream stream(text);
		std::vector<std::string> words;
		for (std::string word; stream >> word;) words.push_back(word);
		if (words.empty()) return;
		const std::string& record = words.front();
		if (record.front() == '#')
			readComment(words);
		else if (record == kVertex)
			readVertex(words);
		else if (record == kEdge)
			readEdge(words);
		else if (record == kFix)
			readFix(words);
		else
			throw InputError(
				place() + "unknown record " + record + "; semloop reads " + kVertex + ", " + kEdge +
				" and " + kFix);
	}

	void readComment(const std::vector<std::string>& words)
	{
		if (words.size() != 4 || words[0] != "#" || words[1] != "semloop") return;
		if (words[2] == "first_object_id")
		{
			if (!vertices_.empty())
				throw InputError(place() + "first_object_id must stand before the vertices");
			firstObjectId_ = id(words[3]);
		}
		else if (words[2] == "kind")
		{
			const auto name = std::find(kKindNames.begin(), kKindNames.end(), words[3]);
			if (name == kKindNames.end())
				throw InputError(
					place() + "unknown kind of edge " + words[3] +
					"; use odometry, observation or loop");
			nextKind_ = static_cast<PoseEdge::Kind>(name - kKindNames.begin());
		}
	}

	void readVertex(const std::vector<std::string>& words)
	{
		requireWords(words, 9);
		const uint64_t vertex = id(words[1]);
		if (!lineOfVertex_.emplace(vertex, line_).second)
			throw InputError(
				place() + "vertex " + words[1] + " is there already, in line " +
				std::to_string(lineOfVertex_.at(vertex)));
		vertices_.push_back({vertex, transform(words, 2)});
	}

	void readEdge(const std::vector<std::string>& words)
	{
		requireWords(words, 31);
		Edge edge{line_, id(words[1]), id(words[2]), {}, nextKind_};
		nextKind_.reset();
		edge.edge.Z_a_b = transform(words, 3).toPose();
		std::size_t word = 10;
		for (int row = 0; row < 6; ++row)
			for (int column = row; column < 6; ++column)
				edge.edge.information(row, column) = edge.edge.information(column, row) =
					scale_[row] * number(words[word++]) * scale_[column];
		edges_.push_back(edge);
	}

	void readFix(const std::vector<std::string>& words)
	{
		requireWords(words, 2);
		if (fixed_)
			throw InputError(
				place() + "a second " + kFix + "; semloop holds one camera, the world");
		fixed_ = {id(words[1]), line_};
	}

	void requireWords(const std::vector<std::string>& words, std::size_t count) const
	{
		if (words.size() != count)
			throw InputError(
				place() + words[0] + " needs " + std::to_string(count - 1) +
				" numbers, this line has " + std::to_string(words.size() - 1) +
				(words.size() < count ? "; is the file cut?" : ""));
	}

	double number(const std::string& word) const
	{
		double value = 0;
		const char* end = word.data() + word.size();
		const auto [rest, error] = std::from_chars(word.data(), end, value);
		if (error == std::errc::result_out_of_range && rest == end)
			throw InputError(place() + word + " is out of the range of numbers");
		if (error != std::errc{} || rest != end)
			throw InputError(place() + word + " is not a number");
		if (!std::isfinite(value)) throw InputError(place() + word + " is not finite");
		return value;
	}

	uint64_t id(const std::string& word) const
	{
		uint64_t value = 0;
		const char* end = word.data() + word.size();
		const auto [rest, error] = std::from_chars(word.data(), end, value);
		if (error != std::errc{} || rest != end || value > kLargestId)
			throw InputError(place() + word + " is not an id; use an integer from 0 to 2^31 - 1");
		return value;
	}

	RigidTransform transform(const std::vector<std::string>& words, std::size_t first) const
	{
		std::array<double, 7> v;
		for (std::size_t i = 0; i < v.size(); ++i) v[i] = number(words[first + i]);
		RigidTransform T{
			Eigen::Quaterniond(v[6], v[3], v[4], v[5]), Eigen::Vector3d(v[0], v[1], v[2])};
		if (!(std::abs(T.rotation.norm() - 1) <= 0.01))
			throw InputError(
				place() + "the quaternion's length is " + std::to_string(T.rotation.norm()) +
				", not 1; the order is qx qy qz qw");
		T.rotation.normalize();
		return T;
	}

	NodeId nodeOf(uint64_t vertex) const
	{
		return vertex < firstObjectId_ ? NodeId::camera(vertex)
									   : NodeId::object(vertex - firstObjectId_);
	}

	void addNodes()
	{
		if (fixed_)
		{
			line_ = fixed_->second;
			if (!lineOfVertex_.count(fixed_->first) || fixed_->first >= firstObjectId_)
				throw InputError(
					place() + kFix + " " + std::to_string(fixed_->first) + ": no such camera");
			// The first camera that the graph gets is the one that stays.
			graph_.setNode(nodeOf(fixed_->first), {});
		}
		for (const Vertex& vertex : vertices_) graph_.setNode(nodeOf(vertex.id), vertex.T.toPose());
	}

	void addEdges()
	{
		for (Edge& edge : edges_)
		{
			line_ = edge.line;
			for (const uint64_t end : {edge.a, edge.b})
				if (!lineOfVertex_.count(end))
					throw InputError(place() + "no vertex " + std::to_string(end) + " in the file");
			edge.edge.a = nodeOf(edge.a);
			edge.edge.b = nodeOf(edge.b);
			edge.edge.kind = edge.kind ? *edge.kind : usualKind(edge.edge, graph_.nodes());
			try
			{
				graph_.addEdge(edge.edge);
			}
			catch (const std::invalid_argument& error)
			{
				throw InputError(place() + error.what());
			}
		}
	}

	std::string path_;
	PoseGraph& graph_;
	Vector6 scale_;
	int line_ = 0;
	uint64_t firstObjectId_ = kLargestId + 1;
	std::map<uint64_t, int> lineOfVertex_;
	std::vector<Vertex> vertices_;
	std::vector<Edge> edges_;
	std::optional<PoseEdge::Kind> nextKind_;
	std::optional<std::pair<uint64_t, int>> fixed_;  //!< id and line
};
}  // namespace

void readG2o(const std::string& path, PoseGraph& graph, G2oRotation rotation)
{
	if (!graph.nodes().empty())
		throw std::invalid_argument("reading " + path + ": the pose graph is not empty");
	Reader(path, graph, rotation).read();
}

}  // namespace semloop
