#include <semloop/loop_closure/GraphMatcher.h>

#include <cmath>
#include <limits>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(GraphMatcher, mrpt::rtti::CObject, semloop)

namespace semloop
{
double matchedEdgeShare(
	const SemanticGraph& query, const SemanticGraph& target, const std::vector<Match>& matches,
	double tolerance)
{
	if (query.edges.empty()) return 0;
	constexpr auto kUnmatched = std::numeric_limits<std::size_t>::max();
	std::vector<std::size_t> partner(query.vertices.size(), kUnmatched);
	for (const auto& match : matches) partner.at(match.query) = match.target;

	std::size_t agreeing = 0;
	for (const auto& [a, b] : query.edges)
	{
		const std::size_t ta = partner[a], tb = partner[b];
		if (ta == kUnmatched || tb == kUnmatched || !target.hasEdge(ta, tb)) continue;
		if (std::abs(query.distance(a, b) - target.distance(ta, tb)) <= tolerance) ++agreeing;
	}
	return static_cast<double>(agreeing) / static_cast<double>(query.edges.size());
}

}  // namespace semloop
