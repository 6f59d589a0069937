#include "ObjectEvidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace semloop
{
namespace
{
constexpr float kSmallestScore = 0.005f;
constexpr double kMaxLogOdds = 10;  // nine looks through it remove the best known object

double similarity(const std::vector<float>& a, const std::vector<float>& b)
{
	float sum = 0;
	for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += a[i] * b[i];
	return sum;
}

/** Index of the embedding that the set misses least. */
std::size_t mostRedundant(const std::vector<std::vector<float>>& set)
{
	const std::size_t n = set.size();
	std::vector<std::vector<double>> similarities(n, std::vector<double>(n, -2));
	std::pair<std::size_t, std::size_t> closest = {0, 1};
	for (std::size_t i = 0; i < n; ++i)
		for (std::size_t j = i + 1; j < n; ++j)
		{
			similarities[i][j] = similarities[j][i] = similarity(set[i], set[j]);
			if (similarities[i][j] > similarities[closest.first][closest.second]) closest = {i, j};
		}
	const auto [a, b] = closest;
	double nextToA = -2, nextToB = -2;
	for (std::size_t i = 0; i < n; ++i)
	{
		if (i == a || i == b) continue;
		nextToA = std::max(nextToA, similarities[i][a]);
		nextToB = std::max(nextToB, similarities[i][b]);
	}
	return nextToA > nextToB ? a : b;
}
}  // namespace

LabelScores averageLabels(
	const LabelScores& a, double weightA, const LabelScores& b, double weightB)
{
	std::map<uint32_t, double> sums;
	for (const auto& s : a) sums[s.label] += weightA * double(s.score);
	for (const auto& s : b) sums[s.label] += weightB * double(s.score);
	LabelScores result;
	for (const auto& [label, sum] : sums)
		result.push_back({label, float(sum / (weightA + weightB))});
	std::stable_sort(
		result.begin(), result.end(),
		[](const LabelScore& l, const LabelScore& r) { return l.score > r.score; });
	while (result.size() > 1 && result.back().score < kSmallestScore) result.pop_back();
	return result;
}

double labelOverlap(const LabelScores& a, const LabelScores& b)
{
	double overlap = 0;
	for (const auto& s : a)
		for (const auto& t : b)
			if (s.label == t.label) overlap += double(std::min(s.score, t.score));
	return overlap;
}

void addEmbeddings(
	std::vector<std::vector<float>>& set, const std::vector<std::vector<float>>& added, int maximum)
{
	for (const auto& embedding : added)
	{
		if (embedding.empty()) continue;
		set.push_back(embedding);
		if (int(set.size()) > maximum && set.size() > 1)
			set.erase(set.begin() + std::ptrdiff_t(mostRedundant(set)));
	}
}

double updatedExistence(double p, double logOdds)
{
	const double limit = 1 / (1 + std::exp(-kMaxLogOdds));
	const double now = std::clamp(p, 1 - limit, limit);
	const double sum = std::log(now / (1 - now)) + logOdds;
	return 1 / (1 + std::exp(-std::clamp(sum, -kMaxLogOdds, kMaxLogOdds)));
}

}  // namespace semloop
