#include <mrpt/core/bits_math.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/GraphIndex.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace semloop
{
namespace
{
constexpr double kUsualSize = 0.5;  // of furniture whose extent is not known [m]
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

/** Sums to 1; empty when there are no scores or one label has all. */
std::map<std::string, double> labelShares(const GraphVertex& vertex)
{
	double sum = 0;
	for (const auto& [label, score] : vertex.labelScores)
	{
		if (!(score >= 0 && score <= 1))
			fail(vertex, "the score of its label '" + label + "' is not in [0, 1]; correct it");
		sum += score;
	}
	std::map<std::string, double> shares;
	for (const auto& [label, score] : vertex.labelScores)
		if (score > 0) shares[label] = score / sum;
	if (shares.size() == 1 && shares.begin()->first == vertex.label) shares.clear();
	return shares;
}

double centreSigmaOf(const GraphVertex& vertex)
{
	if (!vertex.completeness) return 0;
	const double size = vertex.extent ? std::max(vertex.extent->x, vertex.extent->y) : kUsualSize;
	return centreSigma(*vertex.completeness, size);
}

bool isBefore(const GraphIndex::Entry& a, const GraphIndex::Entry& b)
{
	return std::tie(a.x, a.vertex) < std::tie(b.x, b.vertex);
}
}  // namespace

GraphIndex::GraphIndex(const SemanticGraph& graph)
{
	for (const GraphVertex& vertex : graph.vertices) append(vertex);
	for (std::size_t i = 0; i < size(); ++i) byLabel_[labelOf_[i]].push_back(entryOf(i));
	for (auto& entries : byLabel_) std::sort(entries.begin(), entries.end(), isBefore);
}

void GraphIndex::add(const GraphVertex& vertex)
{
	append(vertex);
	insertEntry(size() - 1);
}

void GraphIndex::remove(std::size_t number)
{
	const std::size_t last = size() - 1;
	eraseEntry(number);
	if (hasEmbedding_[number]) --embedded_;
	if (!shares_[number].empty()) --uncertain_;
	if (number != last)
	{
		eraseEntry(last);
		ids_[number] = ids_[last];
		points_[number] = points_[last];
		centreVariances_[number] = centreVariances_[last];
		labelOf_[number] = labelOf_[last];
		std::swap(shares_[number], shares_[last]);
		hasEmbedding_[number] = hasEmbedding_[last];
		if (embeddings_.size() > 0)
			embeddings_.col(Eigen::Index(number)) = embeddings_.col(Eigen::Index(last));
	}
	ids_.pop_back();
	points_.pop_back();
	centreVariances_.pop_back();
	labelOf_.pop_back();
	shares_.pop_back();
	hasEmbedding_.pop_back();
	if (number != last) insertEntry(number);
}

/** Everything but the entry of its label. */
void GraphIndex::append(const GraphVertex& vertex)
{
	const auto& p = vertex.position;
	if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
		fail(vertex, "its position is not finite; leave it out");
	const Eigen::VectorXf embedding = meanEmbedding(vertex);
	const bool isSeen = embedding.size() > 0;
	const auto shares = labelShares(vertex);
	if (isSeen && embedded_ > 0 && embedding.size() != embeddings_.rows())
		fail(
			vertex, "its embedding has " + std::to_string(embedding.size()) +
						" numbers, others have " + std::to_string(embeddings_.rows()) +
						"; describe all objects with one network");

	if (isSeen && embedded_ == 0) embeddings_.resize(embedding.size(), 0);
	const auto column = Eigen::Index(size());
	if (isSeen || embedded_ > 0)
	{
		if (const auto room = embeddings_.cols(); room <= column)
		{
			const auto more = std::max<Eigen::Index>({16, 2 * room, column + 1});
			embeddings_.conservativeResize(Eigen::NoChange, more);
			embeddings_.rightCols(more - room).setZero();
		}
		if (isSeen)
			embeddings_.col(column) = embedding;
		else
			embeddings_.col(column).setZero();
	}
	embedded_ += isSeen;

	ids_.push_back(vertex.id);
	points_.push_back(p);
	centreVariances_.push_back(mrpt::square(centreSigmaOf(vertex)));
	labelOf_.push_back(numberOf(vertex.label));
	shares_.emplace_back();
	for (const auto& [label, share] : shares)
		shares_.back().push_back({numberOf(label), float(share)});
	uncertain_ += !shares.empty();
	hasEmbedding_.push_back(isSeen);
}

int GraphIndex::numberOf(const std::string& label)
{
	const auto [place, isNew] = numbers_.emplace(label, int(byLabel_.size()));
	if (isNew)
	{
		byLabel_.emplace_back();
		names_.push_back(label);
	}
	return place->second;
}

GraphIndex::Entry GraphIndex::entryOf(std::size_t vertex) const
{
	const auto& p = points_[vertex];
	return {float(p.x), float(p.y), float(p.z), std::uint32_t(vertex)};
}

void GraphIndex::insertEntry(std::size_t vertex)
{
	auto& entries = byLabel_[labelOf_[vertex]];
	const Entry entry = entryOf(vertex);
	entries.insert(std::lower_bound(entries.begin(), entries.end(), entry, isBefore), entry);
}

void GraphIndex::eraseEntry(std::size_t vertex)
{
	auto& entries = byLabel_[labelOf_[vertex]];
	entries.erase(std::lower_bound(entries.begin(), entries.end(), entryOf(vertex), isBefore));
}

std::size_t GraphIndex::labels() const
{
	return std::size_t(std::count_if(
		byLabel_.begin(), byLabel_.end(), [](const auto& entries) { return !entries.empty(); }));
}

double GraphIndex::area() const
{
	if (points_.empty()) return 0;
	const auto [left, right] = std::minmax_element(
		points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
	const auto [low, high] = std::minmax_element(
		points_.begin(), points_.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
	return std::max(right->x - left->x, kLeastSide) * std::max(high->y - low->y, kLeastSide);
}

int GraphIndex::labelNumber(const std::string& label) const
{
	const auto found = numbers_.find(label);
	return found == numbers_.end() ? kNoLabel : found->second;
}

}  // namespace semloop
