#pragma once

#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphMatcher.h>

namespace semloop
{
struct CliqueMatcherOptions : Options
{
	double sigma = 0.1;          //!< of the difference of two distances [m]
	double maxDifference = 0.5;  //!< more is inconsistent [m]
	int maxEntries =
		50'000'000;  //!< consistent pairs of candidates that a match may need (8 bytes each)

	/** Public, for those that make it without a file. */
	void describe(OptionFields& fields) override;
};

/** The densest clique of pairwise consistent candidates, as in CLIPPER (P. Lusk, K. Fathian and J. How,
 *  "CLIPPER: A graph-theoretic framework for robust data association", ICRA 2021, Problem 3 and Algorithm 1).
 *
 *  A candidate a is a pair (query vertex, target vertex) of one label. Two that share no vertex are
 *  consistent when their horizontal and their vertical distances differ by at most maxDifference between the
 *  graphs (gravity is known), with the affinity M_ab = exp(-(dh^2 + dv^2) / (2 sigma^2)); M_aa = 1. The
 *  relaxed problem
 *      max u' M u / u' u,  u >= 0,  u_a u_b = 0 where a and b are inconsistent
 *  is climbed by projected gradients with a growing penalty on the constraint, from u almost uniform, and the
 *  round(u' M u) largest entries are the clique. score = u' M u. Edges are not looked at.
 *
 *  match() throws InputError when M would need more than maxEntries. */
class CliqueMatcher : public GraphMatcher
{
	DEFINE_MRPT_OBJECT(CliqueMatcher, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	GraphMatching match(const SemanticGraph& query, const SemanticGraph& target) const override;

	CliqueMatcherOptions options;
};

}  // namespace semloop
