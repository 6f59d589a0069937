#include <semloop/config/Error.h>
#include <semloop/loop_closure/GraphIndex.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace semloop
{
namespace
{
constexpr double kLeastSide = 2.0;  // of a map: a single object fills no less [m]

[[noreturn]] void fail(const GraphVertex& vertex, const std::string& problem)
{
	throw InputError("object " + std::to_string(vertex.id) + ": " + problem);
}

/** Direction of the mean; empty without embeddings. */
Eigen::VectorXf meanEmbedding(const GraphVertex& vertex)
{
	Eigen::VectorXf sum;
	for (const auto& embedding : vertex.embeddings)
	{
		if (embedding.empty()) continue;
		const Eigen::Map<const Eigen::VectorXf> values(
			embedding.data(), Eigen::Index(embedding.size()));
		if (!values.allFinite()) fail(vertex, "its embedding is not finite; describe it again");
		if (sum.size() == 0)
			sum = values;
		else if (sum.size() == values.size())
			sum += values;
		else
			fail(vertex, "its embeddings differ in length; describe it again with one network");
	}
	const float length = sum.size() == 0 ? 0 : sum.norm();
	if (length > 0) return sum / length;
	return {};
}
}  // namespace

GraphIndex::GraphIndex(const SemanticGraph& graph)
{
	using mrpt::math::TPoint3D;
	constexpr double kFar = std::numeric_limits<double>::infinity();
	TPoint3D least(kFar, kFar, 0), most(-kFar, -kFar, 0);
	for (std::size_t i = 0; i < graph.vertices.size(); ++i)
	{
		const GraphVertex& vertex = graph.vertices[i];
		const TPoint3D& p = vertex.position;
		if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
			fail(vertex, "its position is not finite; leave it out");
		points_.push_back(p);
		least = {std::min(least.x, p.x), std::min(least.y, p.y), 0};
		most = {std::max(most.x, p.x), std::max(most.y, p.y), 0};
		const auto [place, isNew] = numbers_.emplace(vertex.label, int(byLabel_.size()));
		if (isNew) byLabel_.emplace_back();
		labelOf_.push_back(place->second);
		byLabel_[place->second].push_back({float(p.x), float(p.y), float(p.z), std::uint32_t(i)});

		const Eigen::VectorXf embedding = meanEmbedding(vertex);
		hasEmbedding_.push_back(embedding.size() > 0);
		if (embedding.size() == 0) continue;
		if (embeddings_.size() == 0)
			embeddings_.setZero(embedding.size(), Eigen::Index(graph.vertices.size()));
		if (embedding.size() != embeddings_.rows())
			fail(
				vertex, "its embedding has " + std::to_string(embedding.size()) +
							" numbers, others have " + std::to_string(embeddings_.rows()) +
							"; describe all objects with one network");
		embeddings_.col(Eigen::Index(i)) = embedding;
	}
	for (auto& entries : byLabel_)
		std::sort(
			entries.begin(), entries.end(),
			[](const Entry& a, const Entry& b)
			{ return std::tie(a.x, a.vertex) < std::tie(b.x, b.vertex); });
	if (!points_.empty())
		area_ = std::max(most.x - least.x, kLeastSide) * std::max(most.y - least.y, kLeastSide);
}

int GraphIndex::labelNumber(const std::string& label) const
{
	const auto found = numbers_.find(label);
	return found == numbers_.end() ? kNoLabel : found->second;
}

}  // namespace semloop
