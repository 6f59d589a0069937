#pragma once

#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphMatcher.h>

namespace semloop
{
struct SpectralMatcherOptions : Options
{
	double mu = 5.0;          //!< Eq. (6) [1/m]
	double tolerance = 1e-6;  //!< relative, of the principal eigenvalue
	int maxIterations = 300;  //!< restarts of the eigensolver
	int maxEntries =
		50'000'000;  //!< off-diagonal entries of S that a match may need (12 bytes each)

protected:
	void describe(OptionFields& fields) override;
};

/** The paper's graph matching, Sec. III-C, Eq. (4)-(6): max vec(A)' S vec(A) over assignments A.
 *
 *  A candidate is a pair (query vertex, target vertex) of one label, d_v = 1. Over the candidates,
 *  S(a, a) = 1, and S(a, b) = exp(-mu |d_q - d_t|) where the two query vertices share an edge of
 *  length d_q and the two target vertices one of length d_t; all else is 0 and not stored. The
 *  principal eigenvector of S (non-negative by Perron and Frobenius; M. Leordeanu and M. Hebert, ICCV
 *  2005) is discretised with the linear assignment of Eq. (1) at cost -A*.
 *
 *  As in the paper a query vertex cannot refuse: it stays unmatched only when no target vertex of
 *  its label is left. Pairs of different labels are never matched. score = vec(A)' S vec(A).
 *
 *  O(nonzeros of S) a step of the eigensolver. match() throws InputError when S would need more
 *  than maxEntries. */
class SpectralMatcher : public GraphMatcher
{
	DEFINE_MRPT_OBJECT(SpectralMatcher, semloop)

public:
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;
	GraphMatching match(const SemanticGraph& query, const SemanticGraph& target) const override;

	SpectralMatcherOptions options;
};

}  // namespace semloop
