#include <mrpt/core/initializer.h>
#include <semloop/association/Assignment.h>
#include <semloop/loop_closure/SpectralMatcher.h>

#include <cmath>
#include <limits>

#include "RewardMatrix.h"

IMPLEMENTS_MRPT_OBJECT(SpectralMatcher, GraphMatcher, semloop)

MRPT_INITIALIZER(registerSpectralMatcher)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::SpectralMatcher));
}

namespace semloop
{
namespace
{
/** A from A*: the assignment of least cost -A*(j, k), labels permitting. Indices of candidates. */
std::vector<Match> discretise(
	const RewardMatrix& reward, const Eigen::VectorXd& relaxed, std::size_t queries,
	std::size_t targets)
{
	CostMatrix cost = CostMatrix::Constant(
		static_cast<Eigen::Index>(queries), static_cast<Eigen::Index>(targets),
		std::numeric_limits<double>::infinity());
	for (std::size_t i = 0; i < reward.candidates.size(); ++i)
	{
		const auto& [query, target] = reward.candidates[i];
		cost(query, target) = -relaxed[i];
	}
	std::vector<Match> matches;
	for (const auto& [query, target] : solveAssignment(cost).matches)
		matches.push_back({query, target});
	return matches;
}

/** vec(A)' S vec(A): the diagonal, and every edge that both graphs have, in both orders. */
double objective(
	const SemanticGraph& query, const SemanticGraph& target, const std::vector<Match>& matches,
	double mu)
{
	double score = static_cast<double>(matches.size());
	for (std::size_t a = 0; a < matches.size(); ++a)
		for (std::size_t b = 0; b < a; ++b)
		{
			const auto& [q1, t1] = matches[a];
			const auto& [q2, t2] = matches[b];
			if (query.hasEdge(q1, q2) && target.hasEdge(t1, t2))
				score +=
					2 * std::exp(-mu * std::abs(query.distance(q1, q2) - target.distance(t1, t2)));
		}
	return score;
}
}  // namespace

void SpectralMatcherOptions::describe(OptionFields& fields)
{
	fields.number(
		"mu", mu, 0, 1000, "edges that differ by 1 / mu metres earn 1 / e, Eq. (6) [1/m]");
	fields.number("tolerance", tolerance, 1e-12, 0.1, "relative, of the principal eigenvalue");
	fields.integer("max_iterations", maxIterations, 1, 100000, "restarts of the eigensolver");
	fields.integer(
		"max_entries", maxEntries, 1, 1'000'000'000,
		"largest number of rewards in S (12 bytes each); more stops with an error");
}

void SpectralMatcher::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

GraphMatching SpectralMatcher::match(const SemanticGraph& query, const SemanticGraph& target) const
{
	GraphMatching result;
	const auto reward = buildRewardMatrix(query, target, options.mu, options.maxEntries);
	if (reward.candidates.empty()) return result;
	const auto relaxed =
		principalEigenvector(reward.upper, options.tolerance, options.maxIterations);
	result.matches = discretise(reward, relaxed, query.vertices.size(), target.vertices.size());
	result.score = objective(query, target, result.matches, options.mu);
	return result;
}

}  // namespace semloop
