#pragma once

#include <semloop/config/Options.h>
#include <semloop/loop_closure/GeometricVerification.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/loop_closure/ObjectAligner.h>

#include <string>

namespace semloop
{
struct SemanticLoopDetectorOptions : Options
{
	std::string matcher = "semloop::SpectralMatcher";  //!< a registered GraphMatcher
	int minObservations = 5;    //!< objects that were seen less often stay out of both graphs
	double minEdgeShare = 0.5;  //!< Sec. IV-B
	double edgeLengthTolerance = 0.5;  //!< of a matched edge [m]
	GeometricVerificationOptions verification;

protected:
	void describe(OptionFields& fields) override;
};

/** The paper's loop detection, Sec. III-C and IV-B, with the checks that keep false loops out:
 *
 *  1. graphs of the query's and of the target's objects;
 *  2. correspondences (GraphMatcher);
 *  3. at least minEdgeShare of the query's edges are matched;
 *  4. the centres fit one rigid motion (verifyGeometry), and no other place fits as well: a rival
 *     counts however far it is;
 *  5. the surfaces of the matched objects align (ObjectAligner).
 *
 *  Query and target are in one (drifted) world, so T_target_query is the correction of the drift.
 *  Every rejection carries its numbers; a graph too large for the matcher is a rejection too. */
class SemanticLoopDetector : public LoopDetector
{
	DEFINE_MRPT_OBJECT(SemanticLoopDetector, semloop)

public:
	SemanticLoopDetector();

	/** Own keys and those of the verification are in `section`, the matcher's in [graph_matching],
	 *  the aligner's in [alignment]. Throws UsageError when `matcher` is no registered GraphMatcher. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	/** Steps 1 to 5. */
	LoopVerdict detect(
		const CObjectMap& map, const std::set<ObjectId>& query,
		const std::set<ObjectId>& target) const override;

	/** Steps 2 to 4, for graphs without surfaces. */
	LoopVerdict detect(const SemanticGraph& query, const SemanticGraph& target) const;

	SemanticLoopDetectorOptions options;
	ObjectAligner aligner;

private:
	GraphMatcher::Ptr matcher_;
};

}  // namespace semloop
