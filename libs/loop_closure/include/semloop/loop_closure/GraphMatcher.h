#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/object_map/SemanticGraph.h>

#include <string>
#include <vector>

namespace semloop
{
/** Vertex indices, query first. */
struct Match
{
	std::size_t query = 0;
	std::size_t target = 0;
	bool operator==(const Match& o) const { return query == o.query && target == o.target; }
};

struct GraphMatching
{
	std::vector<Match> matches;  //!< by query index; every vertex at most once
	double score = 0.0;          //!< the matcher's own objective
};

/** Share of the query's edges that the matches keep, in [0, 1] (Sec. IV-B: a loop is accepted from
 *  50 % on): both ends are matched, the partners share an edge, and the two lengths differ by at
 *  most `tolerance` [m]. 0 when the query has no edge. */
double matchedEdgeShare(
	const SemanticGraph& query, const SemanticGraph& target, const std::vector<Match>& matches,
	double tolerance);

/** Correspondences between two graphs from labels and topology (Sec. III-C). A module. */
class GraphMatcher : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(GraphMatcher)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;
	/** An empty graph on either side gives no matches. */
	virtual GraphMatching match(const SemanticGraph& query, const SemanticGraph& target) const = 0;
};

}  // namespace semloop
