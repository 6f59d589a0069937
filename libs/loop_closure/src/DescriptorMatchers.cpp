#include <mrpt/core/initializer.h>
#include <semloop/association/Assignment.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/DescriptorMatchers.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string_view>
#include <utility>

IMPLEMENTS_MRPT_OBJECT(RandomWalkMatcher, GraphMatcher, semloop)
IMPLEMENTS_MRPT_OBJECT(HistogramMatcher, GraphMatcher, semloop)

MRPT_INITIALIZER(registerDescriptorMatchers)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::RandomWalkMatcher));
	mrpt::rtti::registerClass(CLASS_ID(semloop::HistogramMatcher));
}

namespace semloop
{
namespace
{
constexpr double kMostSteps = 5e9;  // of the assignment: some seconds

/** How often a vertex' neighbourhood reads so, by the labels' numbers packed into a key, ascending. */
using Descriptor = std::vector<std::pair<std::uint64_t, float>>;

/** Numbers of labels that are the same in both graphs. */
class LabelNumbers
{
public:
	std::vector<std::uint64_t> of(const SemanticGraph& graph)
	{
		std::vector<std::uint64_t> numbers;
		for (const auto& vertex : graph.vertices)
			numbers.push_back(numbers_.emplace(vertex.label, numbers_.size() + 1).first->second);
		return numbers;
	}
	/** The key of a sequence that is one label longer. */
	std::uint64_t extended(std::uint64_t key, std::uint64_t label) const
	{
		return key * (numbers_.size() + 1) + label;
	}

private:
	std::map<std::string_view, std::uint64_t> numbers_;
};

std::vector<std::vector<std::size_t>> neighboursOf(const SemanticGraph& graph)
{
	std::vector<std::vector<std::size_t>> neighbours(graph.vertices.size());
	for (const auto& [a, b] : graph.edges)
	{
		neighbours[a].push_back(b);
		neighbours[b].push_back(a);
	}
	return neighbours;
}

Descriptor counted(std::vector<std::uint64_t>& keys)
{
	std::sort(keys.begin(), keys.end());
	Descriptor descriptor;
	for (const std::uint64_t key : keys)
		if (!descriptor.empty() && descriptor.back().first == key)
			++descriptor.back().second;
		else
			descriptor.emplace_back(key, 1.0f);
	return descriptor;
}

/** Sum over the keys that both have. */
template <class Combine>
double overlap(const Descriptor& a, const Descriptor& b, const Combine& combine)
{
	double sum = 0;
	for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();)
	{
		if (i->first == j->first) sum += double(combine(i->second, j->second));
		if (i->first <= j->first)
			++i;
		else
			++j;
	}
	return sum;
}

void requireFeasible(const SemanticGraph& query, const SemanticGraph& target)
{
	const auto smaller = double(std::min(query.vertices.size(), target.vertices.size()));
	const auto larger = double(std::max(query.vertices.size(), target.vertices.size()));
	if (smaller * smaller * larger > kMostSteps)
		throw InputError(
			"graphs of " + std::to_string(query.vertices.size()) + " and " +
			std::to_string(target.vertices.size()) +
			" objects are too large for this matcher; take another or smaller graphs");
}

/** The assignment of the largest sum of similarities, which are in [0, 1]; pairs of different labels are
 *  never matched. */
template <class Similarity>
GraphMatching matchedBy(
	const SemanticGraph& query, const SemanticGraph& target, const Similarity& similarity)
{
	CostMatrix cost = CostMatrix::Constant(
		Eigen::Index(query.vertices.size()), Eigen::Index(target.vertices.size()),
		std::numeric_limits<double>::infinity());
	for (std::size_t j = 0; j < query.vertices.size(); ++j)
		for (std::size_t k = 0; k < target.vertices.size(); ++k)
			if (query.vertices[j].label == target.vertices[k].label)
				cost(Eigen::Index(j), Eigen::Index(k)) = -similarity(j, k);
	const auto assignment = solveAssignment(cost);
	GraphMatching result;
	result.score = -assignment.cost;
	for (const auto& [j, k] : assignment.matches) result.matches.push_back({j, k});
	return result;
}

/** std::uniform_int_distribution differs between libraries. */
std::size_t drawn(std::mt19937& random, std::size_t count)
{
	return std::size_t(random()) % count;
}

std::vector<Descriptor> walksOf(
	const SemanticGraph& graph, const std::vector<std::uint64_t>& labels,
	const LabelNumbers& numbers, const RandomWalkMatcherOptions& options)
{
	const auto neighbours = neighboursOf(graph);
	std::vector<Descriptor> descriptors;
	std::vector<std::uint64_t> keys;
	for (std::size_t start = 0; start < graph.vertices.size(); ++start)
	{
		std::mt19937 random(std::uint32_t(options.seed) + std::uint32_t(start));
		keys.clear();
		for (int walk = 0; walk < options.walks; ++walk)
		{
			std::size_t at = start, before = start;
			std::uint64_t key = labels[start];
			for (int step = 1; step < options.depth && !neighbours[at].empty(); ++step)
			{
				const auto& ways = neighbours[at];
				std::size_t next = ways[drawn(random, ways.size())];
				while (next == before && ways.size() > 1) next = ways[drawn(random, ways.size())];
				before = std::exchange(at, next);
				key = numbers.extended(key, labels[at]);
			}
			keys.push_back(key);
		}
		descriptors.push_back(counted(keys));
	}
	return descriptors;
}

/** Scaled to length 1. */
std::vector<Descriptor> pathsOf(
	const SemanticGraph& graph, const std::vector<std::uint64_t>& labels,
	const LabelNumbers& numbers)
{
	const auto neighbours = neighboursOf(graph);
	std::vector<Descriptor> ends;  // of the second edge, by the vertex in the middle
	std::vector<std::uint64_t> keys;
	for (const auto& around : neighbours)
	{
		keys.clear();
		for (const std::size_t end : around) keys.push_back(labels[end]);
		ends.push_back(counted(keys));
	}
	std::vector<Descriptor> descriptors;
	for (std::size_t start = 0; start < graph.vertices.size(); ++start)
	{
		std::map<std::uint64_t, float> counts;
		for (const std::size_t middle : neighbours[start])
		{
			const std::uint64_t key = numbers.extended(labels[start], labels[middle]);
			for (const auto& [label, count] : ends[middle])
				counts[numbers.extended(key, label)] += count;
			--counts[numbers.extended(key, labels[start])];  // straight back is no path
		}
		float squared = 0;
		for (const auto& [key, count] : counts) squared += count * count;
		auto& descriptor = descriptors.emplace_back();
		for (const auto& [key, count] : counts)
			if (count > 0) descriptor.emplace_back(key, count / std::sqrt(squared));
	}
	return descriptors;
}
}  // namespace

void RandomWalkMatcherOptions::describe(OptionFields& fields)
{
	fields.integer("walks", walks, 1, 100000, "random walks from each vertex");
	fields.integer("depth", depth, 2, 8, "vertices of a walk");
	fields.number("embedding_weight", embeddingWeight, 0, 1, "of the embeddings' similarity");
	fields.integer("seed", seed, 0, 1000000000, "of the walks");
}

void RandomWalkMatcher::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

GraphMatching RandomWalkMatcher::match(
	const SemanticGraph& query, const SemanticGraph& target) const
{
	requireFeasible(query, target);
	LabelNumbers numbers;
	const auto queryLabels = numbers.of(query), targetLabels = numbers.of(target);
	const auto walks = walksOf(query, queryLabels, numbers, options);
	const auto targetWalks = walksOf(target, targetLabels, numbers, options);
	return matchedBy(
		query, target,
		[&](std::size_t j, std::size_t k)
		{
			const double common =
				overlap(walks[j], targetWalks[k], [](float a, float b) { return std::min(a, b); }) /
				options.walks;
			const auto looks =
				embeddingSimilarity(query.vertices[j].embeddings, target.vertices[k].embeddings);
			if (!looks) return common;
			return (1 - options.embeddingWeight) * common +
				   options.embeddingWeight * std::clamp(*looks, 0.0, 1.0);
		});
}

void HistogramMatcher::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	struct None : Options
	{
		void describe(OptionFields&) override {}
	};
	None().loadFromConfigFile(config, section);
}

GraphMatching HistogramMatcher::match(const SemanticGraph& query, const SemanticGraph& target) const
{
	requireFeasible(query, target);
	LabelNumbers numbers;
	const auto queryLabels = numbers.of(query), targetLabels = numbers.of(target);
	const auto paths = pathsOf(query, queryLabels, numbers);
	const auto targetPaths = pathsOf(target, targetLabels, numbers);
	return matchedBy(
		query, target,
		[&](std::size_t j, std::size_t k)
		{ return overlap(paths[j], targetPaths[k], [](float a, float b) { return a * b; }); });
}

}  // namespace semloop
