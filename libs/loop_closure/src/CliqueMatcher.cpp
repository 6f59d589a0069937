#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/CliqueMatcher.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>

IMPLEMENTS_MRPT_OBJECT(CliqueMatcher, GraphMatcher, semloop)

MRPT_INITIALIZER(registerCliqueMatcher)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::CliqueMatcher));
}

namespace semloop
{
namespace
{
constexpr int kMostPenalties = 100, kMostSteps = 200, kMostHalvings = 30;
constexpr double kTolerance = 1e-8;

/** The affinities of consistent pairs, by row; the diagonal is 1 and not stored. */
struct Affinity
{
	std::vector<Match> candidates;
	std::vector<std::size_t> begin{0};
	std::vector<std::uint32_t> column;
	std::vector<float> value;

	Eigen::Index size() const { return Eigen::Index(candidates.size()); }
};

std::vector<Match> candidatesOf(const SemanticGraph& query, const SemanticGraph& target)
{
	std::map<std::string_view, std::vector<std::size_t>> byLabel;
	for (std::size_t k = 0; k < target.vertices.size(); ++k)
		byLabel[target.vertices[k].label].push_back(k);
	std::vector<Match> candidates;
	for (std::size_t j = 0; j < query.vertices.size(); ++j)
		if (const auto found = byLabel.find(query.vertices[j].label); found != byLabel.end())
			for (const std::size_t k : found->second) candidates.push_back({j, k});
	return candidates;
}

Affinity affinityOf(
	const SemanticGraph& query, const SemanticGraph& target, const CliqueMatcherOptions& options)
{
	Affinity affinity;
	affinity.candidates = candidatesOf(query, target);
	for (const auto& a : affinity.candidates)
	{
		for (std::size_t i = 0; i < affinity.candidates.size(); ++i)
		{
			const Match& b = affinity.candidates[i];
			if (a.query == b.query || a.target == b.target) continue;
			const auto dq = query.vertices[b.query].position - query.vertices[a.query].position;
			const auto dt = target.vertices[b.target].position - target.vertices[a.target].position;
			const double vertical = dq.z - dt.z;
			if (std::abs(vertical) > options.maxDifference) continue;
			const double horizontal = std::hypot(dq.x, dq.y) - std::hypot(dt.x, dt.y);
			if (std::abs(horizontal) > options.maxDifference) continue;
			affinity.column.push_back(std::uint32_t(i));
			affinity.value.push_back(float(std::exp(
				-0.5 * (horizontal * horizontal + vertical * vertical) /
				(options.sigma * options.sigma))));
		}
		if (affinity.column.size() > std::size_t(options.maxEntries))
			throw InputError(
				"too many objects look alike: the affinities of " +
				std::to_string(affinity.candidates.size()) + " candidates have more than " +
				std::to_string(options.maxEntries) +
				" entries; raise max_entries or match smaller graphs");
		affinity.begin.push_back(affinity.column.size());
	}
	return affinity;
}

/** M u, and for each candidate the sum of u over those that are inconsistent with it. */
struct Product
{
	Eigen::VectorXd affine, inconsistent;
};

Product product(const Affinity& affinity, const Eigen::VectorXd& u)
{
	Product result{u, Eigen::VectorXd::Constant(u.size(), u.sum()) - u};
	for (Eigen::Index a = 0; a < u.size(); ++a)
		for (std::size_t i = affinity.begin[a]; i < affinity.begin[a + 1]; ++i)
		{
			const double other = u[affinity.column[i]];
			result.affine[a] += double(affinity.value[i]) * other;
			result.inconsistent[a] -= other;
		}
	result.inconsistent = result.inconsistent.cwiseMax(0.0);  // rounding
	return result;
}

/** What the penalty must grow by before the constraints bind more; none when they hold. */
std::optional<double> penaltyStep(const Product& at, const Eigen::VectorXd& u)
{
	double sum = 0;
	int count = 0;
	for (Eigen::Index a = 0; a < u.size(); ++a)
		if (u[a] > kTolerance && at.inconsistent[a] > kTolerance)
		{
			sum += at.affine[a] / at.inconsistent[a];
			++count;
		}
	if (count == 0) return {};
	return sum / count;
}

/** Two cliques of one size would hold each other up for ever. */
Eigen::VectorXd almostUniform(Eigen::Index size)
{
	constexpr double kGoldenRatio = 0.6180339887498949, kDifference = 0.01;
	Eigen::VectorXd u(size);
	for (Eigen::Index i = 0; i < size; ++i)
		u[i] = 1 + kDifference * std::fmod(kGoldenRatio * double(i), 1.0);
	return u.normalized();
}

/** Projected gradient ascent of u' (M - penalty C) u on the sphere, u >= 0. */
void climb(const Affinity& affinity, double penalty, Eigen::VectorXd& u, Product& at)
{
	for (int step = 0; step < kMostSteps; ++step)
	{
		const Eigen::VectorXd gradient = at.affine - penalty * at.inconsistent;
		const double value = u.dot(gradient);
		double length = 1;
		bool improved = false;
		for (int halving = 0; halving < kMostHalvings && !improved; ++halving, length *= 0.5)
		{
			Eigen::VectorXd next = (u + length * gradient).cwiseMax(0.0);
			const double norm = next.norm();
			if (norm == 0) continue;
			next /= norm;
			const auto there = product(affinity, next);
			const double gain = next.dot(there.affine - penalty * there.inconsistent) - value;
			improved = gain > kTolerance;
			if (improved)
			{
				u = next;
				at = there;
			}
		}
		if (!improved) return;
	}
}
}  // namespace

void CliqueMatcherOptions::describe(OptionFields& fields)
{
	fields.number(
		"sigma", sigma, 0.001, 10, "of the difference of two distances of the same objects [m]");
	fields.number("max_difference", maxDifference, 0.001, 10, "more is inconsistent [m]");
	fields.integer(
		"max_entries", maxEntries, 1, 1'000'000'000,
		"largest number of consistent pairs (8 bytes each); more stops with an error");
}

void CliqueMatcher::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
}

GraphMatching CliqueMatcher::match(const SemanticGraph& query, const SemanticGraph& target) const
{
	GraphMatching result;
	const auto affinity = affinityOf(query, target, options);
	if (affinity.candidates.empty()) return result;
	Eigen::VectorXd u = almostUniform(affinity.size());
	auto at = product(affinity, u);
	u = at.affine.cwiseProduct(u).normalized();
	at = product(affinity, u);
	double penalty = 0;
	for (int round = 0; round < kMostPenalties; ++round)
	{
		const auto more = penaltyStep(at, u);
		if (!more) break;
		penalty += *more;
		climb(affinity, penalty, u, at);
	}
	result.score = u.dot(at.affine);

	std::vector<std::size_t> order(affinity.candidates.size());
	std::iota(order.begin(), order.end(), 0);
	std::stable_sort(
		order.begin(), order.end(),
		[&](std::size_t a, std::size_t b) { return u[Eigen::Index(a)] > u[Eigen::Index(b)]; });
	order.resize(std::min(order.size(), std::size_t(std::lround(result.score))));
	std::vector<bool> usedQuery(query.vertices.size()), usedTarget(target.vertices.size());
	for (const std::size_t i : order)
	{
		const Match& match = affinity.candidates[i];
		if (u[Eigen::Index(i)] <= kTolerance || usedQuery[match.query] || usedTarget[match.target])
			continue;
		usedQuery[match.query] = usedTarget[match.target] = true;
		result.matches.push_back(match);
	}
	std::sort(
		result.matches.begin(), result.matches.end(),
		[](const Match& a, const Match& b) { return a.query < b.query; });
	return result;
}

}  // namespace semloop
