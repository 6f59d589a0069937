#include "CandidateIndex.h"

#include <semloop/association/MatchingCost.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

namespace semloop
{
CandidateIndex::CandidateIndex(
	const SemanticGraph& query, const SemanticGraph& target,
	const GeometricVerificationOptions& options)
	: candidates_(query.vertices.size()),
	  horizontalGate_(options.maxHorizontalError),
	  verticalGate_(options.maxVerticalError)
{
	std::map<std::string_view, std::vector<std::size_t>> byLabel;
	for (std::size_t k = 0; k < target.vertices.size(); ++k)
		byLabel[target.vertices[k].label].push_back(k);
	for (std::size_t j = 0; j < query.vertices.size(); ++j)
	{
		const auto& vertex = query.vertices[j];
		positions_.push_back(vertex.position);
		const auto found = byLabel.find(vertex.label);
		if (found == byLabel.end()) continue;
		for (const std::size_t k : found->second)
		{
			const auto& other = target.vertices[k];
			const double similarity =
				embeddingSimilarity(vertex.embeddings, other.embeddings).value_or(1.0);
			if (similarity < options.minSimilarity) continue;
			const auto& p = other.position;
			candidates_[j].push_back({p.x, p.y, p.z, std::clamp(1 - similarity, 0.0, 1.0), k});
		}
		std::sort(
			candidates_[j].begin(), candidates_[j].end(),
			[](const auto& a, const auto& b)
			{ return std::tie(a.x, a.target) < std::tie(b.x, b.target); });
	}
}

CandidateIndex CandidateIndex::mirrored() const
{
	CandidateIndex result = *this;
	for (auto& position : result.positions_) position.x = -position.x;
	return result;
}

CandidateIndex CandidateIndex::withGatesScaledBy(double factor) const
{
	CandidateIndex result = *this;
	result.horizontalGate_ *= factor;
	result.verticalGate_ *= factor;
	return result;
}

std::pair<const CandidateIndex::Candidate*, const CandidateIndex::Candidate*> CandidateIndex::range(
	std::size_t query, double low, double high) const
{
	const auto& all = candidates_[query];
	const auto* begin = all.data();
	const auto* end = begin + all.size();
	begin = std::partition_point(begin, end, [&](const Candidate& c) { return c.x < low; });
	end = std::partition_point(begin, end, [&](const Candidate& c) { return c.x <= high; });
	return {begin, end};
}

double CandidateIndex::misfit(
	const mrpt::math::TPoint3D& p_target, const Candidate& candidate) const
{
	const double horizontal =
		(mrpt::square(candidate.x - p_target.x) + mrpt::square(candidate.y - p_target.y)) /
		mrpt::square(horizontalGate_);
	const double vertical = mrpt::square((candidate.z - p_target.z) / verticalGate_);
	if (horizontal > 1 || vertical > 1) return std::numeric_limits<double>::infinity();
	return horizontal + vertical + candidate.dissimilarity;
}

Support SupportCounter::count(const YawPose& pose, int atLeast)
{
	++call_;
	Support support;
	int remaining = static_cast<int>(index_.queries());
	for (std::size_t j = 0; j < index_.queries(); ++j, --remaining)
	{
		if (support.inliers + remaining < atLeast) break;
		const auto p = pose * index_.position(j);
		const auto [begin, end] = index_.near(j, p);
		const CandidateIndex::Candidate* best = nullptr;
		double least = std::numeric_limits<double>::infinity();
		for (const auto* candidate = begin; candidate != end; ++candidate)
		{
			const double misfit = index_.misfit(p, *candidate);
			if (misfit >= least || used_[candidate->target] == call_) continue;
			least = misfit;
			best = candidate;
		}
		if (!best) continue;
		used_[best->target] = call_;
		++support.inliers;
		support.quality += 1 - least / 6;
	}
	return support;
}

}  // namespace semloop
