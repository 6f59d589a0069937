#pragma once

#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphMatcher.h>

namespace semloop
{
struct RandomWalkMatcherOptions : Options
{
	int walks = 200;  //!< from each vertex
	int depth = 4;    //!< vertices of a walk, the first one included
	double embeddingWeight = 0.5;
	int seed = 1;

	void describe(OptionFields& fields) override;
};

/** Matches vertices whose neighbourhoods read alike on random walks: X-View (A. Gawel, C. Del Don, R.
 *  Siegwart, J. Nieto and C. Cadena, "X-View: Graph-Based Semantic Multi-View Localization", RA-L 2018), with
 *  embeddings as in S. Lin et al., "Topology Aware Object-Level Semantic Mapping Towards More Robust Loop
 *  Closure", RA-L 2021.
 *
 *  A walk goes along edges, never straight back where there is another way, and is read as the sequence of its
 *  labels. Similarity of two vertices of one label: walks that both have / walks, mixed with the embeddings'
 *  similarity (clipped to [0, 1]) by embeddingWeight when both have one. The assignment of the largest sum is
 *  the matching, and that sum the score. Distances are not looked at. match() throws InputError when the
 *  assignment would take minutes: beyond some 1700 x 1700 objects. */
class RandomWalkMatcher : public GraphMatcher
{
	DEFINE_MRPT_OBJECT(RandomWalkMatcher, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	GraphMatching match(const SemanticGraph& query, const SemanticGraph& target) const override;

	RandomWalkMatcherOptions options;
};

/** Matches vertices whose neighbourhoods have the same paths: X. Guo, J. Hu, J. Chen, F. Deng and T. Lam,
 *  "Semantic Histogram Based Graph Matching for Real-Time Multi-Robot Global Localization in Large Scale
 *  Environment", RA-L 2021.
 *
 *  The descriptor of a vertex counts, for each triple of labels, the paths of two edges that begin at the
 *  vertex and read so. Similarity of two vertices of one label: the cosine of their descriptors. The
 *  assignment of the largest sum is the matching, and that sum the score. Distances are not looked at.
 *  match() throws as RandomWalkMatcher's does. */
class HistogramMatcher : public GraphMatcher
{
	DEFINE_MRPT_OBJECT(HistogramMatcher, semloop)

public:
	/** It has no options; throws UsageError on any key. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	GraphMatching match(const SemanticGraph& query, const SemanticGraph& target) const override;
};

}  // namespace semloop
