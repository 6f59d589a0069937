#include "RewardMatrix.h"

#include <semloop/config/Error.h>

#include <cmath>
#include <map>
#include <numeric>
#include <string_view>

namespace semloop
{
namespace
{
/** Target vertices grouped by the labels of the query: the partners of a query vertex are a range
 *  of ranks. Labels that the query does not have are left out. */
struct LabelOrder
{
	std::vector<int> labelOfQuery;
	std::vector<int> begin;  //!< ranks begin[l] .. begin[l + 1] - 1 have label l
	std::vector<std::size_t> vertexOfRank;
	std::vector<int> rankOfVertex;  //!< -1: no query vertex has this label

	int labels() const { return static_cast<int>(begin.size()) - 1; }
};

LabelOrder orderByLabel(const SemanticGraph& query, const SemanticGraph& target)
{
	LabelOrder order;
	std::map<std::string_view, int> indexOf;
	for (const auto& vertex : query.vertices)
		order.labelOfQuery.push_back(
			indexOf.emplace(vertex.label, static_cast<int>(indexOf.size())).first->second);

	std::vector<int> labelOfTarget;
	order.begin.assign(indexOf.size() + 1, 0);
	for (const auto& vertex : target.vertices)
	{
		const auto found = indexOf.find(vertex.label);
		labelOfTarget.push_back(found == indexOf.end() ? -1 : found->second);
		if (found != indexOf.end()) ++order.begin[found->second + 1];
	}
	std::partial_sum(order.begin.begin(), order.begin.end(), order.begin.begin());

	std::vector<int> next(order.begin.begin(), order.begin.end() - 1);
	order.vertexOfRank.resize(order.begin.back());
	order.rankOfVertex.assign(target.vertices.size(), -1);
	for (std::size_t k = 0; k < target.vertices.size(); ++k)
	{
		if (labelOfTarget[k] < 0) continue;
		const int rank = next[labelOfTarget[k]]++;
		order.rankOfVertex[k] = rank;
		order.vertexOfRank[rank] = k;
	}
	return order;
}

/** Neighbours and edge lengths of each vertex, ascending, in compressed rows. */
struct Adjacency
{
	std::vector<int> begin;
	std::vector<int> neighbour;
	std::vector<double> length;

	explicit Adjacency(std::size_t rows) : begin(rows + 1, 0) {}
	void allocate()
	{
		std::partial_sum(begin.begin(), begin.end(), begin.begin());
		neighbour.resize(begin.back());
		length.resize(begin.back());
	}
};

/** Vertices are renumbered by rank; those of rank -1 are left out. */
Adjacency adjacencyOf(const SemanticGraph& graph, const std::vector<int>& rank, std::size_t ranks)
{
	Adjacency unsorted(ranks);
	for (const auto& [a, b] : graph.edges)
		if (rank[a] >= 0 && rank[b] >= 0)
			++unsorted.begin[rank[a] + 1], ++unsorted.begin[rank[b] + 1];
	Adjacency sorted = unsorted;
	unsorted.allocate();
	sorted.allocate();

	auto next = unsorted.begin;
	for (const auto& [a, b] : graph.edges)
	{
		if (rank[a] < 0 || rank[b] < 0) continue;
		const double length = graph.vertices[a].position.distanceTo(graph.vertices[b].position);
		const int atA = next[rank[a]]++, atB = next[rank[b]]++;
		unsorted.neighbour[atA] = rank[b], unsorted.length[atA] = length;
		unsorted.neighbour[atB] = rank[a], unsorted.length[atB] = length;
	}
	// Transposing a symmetric matrix row by row leaves every row sorted.
	next = sorted.begin;
	for (int row = 0; row < static_cast<int>(ranks); ++row)
		for (int i = unsorted.begin[row]; i < unsorted.begin[row + 1]; ++i)
		{
			const int at = next[unsorted.neighbour[i]]++;
			sorted.neighbour[at] = row;
			sorted.length[at] = unsorted.length[i];
		}
	return sorted;
}

/** Where in the row of a target vertex the neighbours of each label begin: (labels + 1) per row. */
std::vector<int> labelRuns(const Adjacency& target, const LabelOrder& order)
{
	const std::size_t rows = order.vertexOfRank.size();
	std::vector<int> runs;
	runs.reserve(rows * order.begin.size());
	for (std::size_t row = 0; row < rows; ++row)
	{
		int i = target.begin[row];
		for (const int firstRank : order.begin)
		{
			while (i < target.begin[row + 1] && target.neighbour[i] < firstRank) ++i;
			runs.push_back(i);
		}
	}
	return runs;
}

/** Fills the rows of S; one object per matrix, so that the loops below stay readable. */
class RowBuilder
{
public:
	RowBuilder(const SemanticGraph& query, const SemanticGraph& target)
		: order_(orderByLabel(query, target)),
		  query_(adjacencyOf(query, identity(query.vertices.size()), query.vertices.size())),
		  target_(adjacencyOf(target, order_.rankOfVertex, order_.vertexOfRank.size())),
		  runs_(labelRuns(target_, order_)),
		  firstColumn_(query.vertices.size() + 1, 0)
	{
		for (std::size_t j = 0; j < query.vertices.size(); ++j)
		{
			const int label = order_.labelOfQuery[j];
			const int partners = order_.begin[label + 1] - order_.begin[label];
			firstColumn_[j + 1] = firstColumn_[j] + partners;
		}
	}

	int queryVertices() const { return static_cast<int>(firstColumn_.size()) - 1; }
	int size() const { return firstColumn_.back(); }

	std::vector<Match> candidates() const
	{
		std::vector<Match> result;
		result.reserve(size());
		for (int j = 0; j < queryVertices(); ++j)
			for (int rank = firstRank(j); rank < endRank(j); ++rank)
				result.push_back({static_cast<std::size_t>(j), order_.vertexOfRank[rank]});
		return result;
	}

	/** Off-diagonal entries of the upper triangle. */
	int64_t countEntries() const
	{
		int64_t count = 0;
		for (int j = 0; j < queryVertices(); ++j)
			for (int rank = firstRank(j); rank < endRank(j); ++rank)
				forEachLaterNeighbour(
					j, [&](int j2, double) { count += runEnd(rank, j2) - runBegin(rank, j2); });
		return count;
	}

	/** Writes the exponents -mu |d_q - d_t| (0 on the diagonal); the caller takes exp() of all. */
	void fill(RewardMatrix::Matrix& upper, double mu) const
	{
		double* value = upper.valuePtr();
		int* column = upper.innerIndexPtr();
		int* rowBegin = upper.outerIndexPtr();
		int at = 0, row = 0;
		for (int j = 0; j < queryVertices(); ++j)
			for (int rank = firstRank(j); rank < endRank(j); ++rank)
			{
				rowBegin[row] = at;
				column[at] = row++;
				value[at++] = 0;
				forEachLaterNeighbour(
					j,
					[&](int j2, double length)
					{
						const int toColumn = firstColumn_[j2] - firstRank(j2);
						for (int i = runBegin(rank, j2); i < runEnd(rank, j2); ++i, ++at)
						{
							column[at] = target_.neighbour[i] + toColumn;
							value[at] = -mu * std::abs(length - target_.length[i]);
						}
					});
			}
		rowBegin[row] = at;
	}

private:
	static std::vector<int> identity(std::size_t size)
	{
		std::vector<int> result(size);
		std::iota(result.begin(), result.end(), 0);
		return result;
	}

	int firstRank(int j) const { return order_.begin[order_.labelOfQuery[j]]; }
	int endRank(int j) const { return order_.begin[order_.labelOfQuery[j] + 1]; }
	int runBegin(int rank, int j) const
	{
		return runs_[static_cast<std::size_t>(rank) * order_.begin.size() + order_.labelOfQuery[j]];
	}
	int runEnd(int rank, int j) const
	{
		return runs_
			[static_cast<std::size_t>(rank) * order_.begin.size() + order_.labelOfQuery[j] + 1];
	}

	template <class Visit>
	void forEachLaterNeighbour(int j, const Visit& visit) const
	{
		for (int i = query_.begin[j]; i < query_.begin[j + 1]; ++i)
			if (query_.neighbour[i] > j) visit(query_.neighbour[i], query_.length[i]);
	}

	LabelOrder order_;
	Adjacency query_, target_;
	std::vector<int> runs_;
	std::vector<int> firstColumn_;  //!< of the candidates of each query vertex
};
}  // namespace

RewardMatrix buildRewardMatrix(
	const SemanticGraph& query, const SemanticGraph& target, double mu, int maxEntries)
{
	const RowBuilder rows(query, target);
	const int64_t entries = rows.countEntries();
	if (entries > maxEntries)
		throw InputError(
			"graph matching: " + std::to_string(query.vertices.size()) + " x " +
			std::to_string(target.vertices.size()) + " objects need " + std::to_string(entries) +
			" rewards, allowed are " + std::to_string(maxEntries) +
			"; match with a part of the map or raise max_entries");

	RewardMatrix reward;
	reward.candidates = rows.candidates();
	reward.upper.resize(rows.size(), rows.size());
	const auto stored = entries + rows.size();
	reward.upper.resizeNonZeros(stored);
	rows.fill(reward.upper, mu);
	Eigen::Map<Eigen::ArrayXd> values(reward.upper.valuePtr(), stored);
	values = values.exp();
	return reward;
}

}  // namespace semloop
