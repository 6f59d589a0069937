#pragma once

#include <semloop/config/Options.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/loop_closure/MapIndex.h>
#include <semloop/loop_closure/ObjectAligner.h>
#include <semloop/loop_closure/PlaceRecognizer.h>

namespace semloop
{
struct SemanticLoopDetectorOptions : Options
{
	int minObservations = 5;          //!< objects that were seen less often stay out of both graphs
	double maxHorizontalError = 0.3;  //!< of matched centres under the surfaces' pose [m]
	double maxVerticalError = 0.25;   //!< same [m]
	PlaceRecognizerOptions recognition;

	void requireConsistent() const override;

protected:
	void describe(OptionFields& fields) override;
};

/** The paper's loop detection, Sec. III-C and IV-B, with the checks that keep false loops out:
 *
 *  1. graphs of the query's and of the target's objects;
 *  2. the place where the query belongs, and how probable it is, rivals in the whole target and the drift
 *     prior weighed (PlaceRecognizer);
 *  3. the surfaces of the matched objects align (ObjectAligner); matches whose centres the surfaces' pose does
 *     not bring together are dropped, and the loop with them when it was most of them.
 *
 *  Query and target are in one (drifted) world, so T_target_query is the correction of the drift.
 *  Every verdict carries its numbers; a graph too large for the matcher is a rejection too. */
class SemanticLoopDetector : public LoopDetector
{
	DEFINE_MRPT_OBJECT(SemanticLoopDetector, semloop)

public:
	/** Own keys and those of the recognition are in `section`, the matcher's in [graph_matching],
	 *  the aligner's in [alignment]. Throws UsageError when `matcher` is neither one of
	 *  PlaceRecognizer::matcherNames() nor a registered GraphMatcher. */
	void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

	SemanticLoopDetector() = default;
	/** Throws as configure() does. */
	explicit SemanticLoopDetector(const SemanticLoopDetectorOptions& options);

	void setConfusionMatrix(const ConfusionMatrix& confusion) override
	{
		recognizer_.setConfusionMatrix(confusion);
	}
	LoopVerdict detect(const LoopQuery& query) override;

	const SemanticLoopDetectorOptions& options() const { return options_; }
	ObjectAligner aligner;

private:
	SemanticLoopDetectorOptions options_;
	PlaceRecognizer recognizer_;
	MapIndex target_;
};

}  // namespace semloop
