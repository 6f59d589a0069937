#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/core/bits_math.h>
#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphIndex.h>
#include <semloop/loop_closure/GraphMatcher.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/loop_closure/PlaceSearch.h>

#include <optional>
#include <string>
#include <vector>

namespace semloop
{
struct PlaceRecognizerOptions : Options
{
	std::string matcher = "pairwise";
	double minProbability = 0.9;  //!< of an accepted place
	int minMatches = 3;
	double maxYawSigma = mrpt::DEG2RAD(8.6);  //!< of an accepted pose [rad]
	double maxPriorSigmas = 5;  //!< further from the prior no place is accepted; 0: any
	PlaceSearchOptions search;

	/** Public: the loop detector has these keys in its own section. */
	void describe(OptionFields& fields) override;
	void requireConsistent() const override;
};

/** Recognises one semantic graph in another, without surfaces, and gives one of three answers:
 *
 *  accepted   the place found is right with minProbability or more;
 *  ambiguous  one of several places is, but not which, or its yaw is open: ask again when the query has
 *             grown;
 *  rejected   no place is.
 *
 *  A matcher proposes places, and PlaceSearch says what each is worth and looks for rivals in the whole map:
 *
 *  pairwise           every pair of candidates proposes a place: no matcher;
 *  spectral-verified  pairs of SpectralMatcher's matches do;
 *  clique             pairs of CliqueMatcher's;
 *  random-walk        pairs of RandomWalkMatcher's;
 *  histogram          pairs of HistogramMatcher's;
 *  spectral           the paper, as published: at least half of the query's edges are matched, and the pose
 *                     is the least-squares one of all matches; no probability. */
class PlaceRecognizer
{
public:
	static std::vector<std::string> matcherNames();

	/** A registered GraphMatcher of another class name proposes places by pairs of its matches, too; what is
	 *  neither is a UsageError, which begins with `key`, where the name stands. */
	explicit PlaceRecognizer(
		const PlaceRecognizerOptions& options = {}, const std::string& key = "matcher");
	/** The matcher's own keys, if it is a module. */
	void configureMatcher(const mrpt::config::CConfigFileBase& config, const std::string& section);

	/** How labels are mistaken for each other; label_accuracy stands for it until then. */
	void setConfusionMatrix(const ConfusionMatrix& confusion);

	/** Whether a matcher needs the target's graph; pairs of candidates need the index only. */
	bool needsTargetGraph() const { return matcher_ != nullptr; }

	/** Verdicts are by ids. Throws InputError when a graph cannot be used (see GraphIndex), or the prior: a pose that is
	 *  not finite, a sigma that is not finite and above 0. */
	LoopVerdict recognize(
		const SemanticGraph& query, const SemanticGraph& target, const GraphIndex& targetIndex,
		const std::optional<PosePrior>& prior = {}) const;
	/** The same without a matcher; throws std::logic_error when needsTargetGraph(). With `priorOf` each place is
	 *  weighed by the prior of the objects that it is made of. */
	LoopVerdict recognize(
		const SemanticGraph& query, const GraphIndex& target,
		const std::optional<PosePrior>& prior = {}, const PriorOfObjects& priorOf = {}) const;

private:
	LoopVerdict publishedVerdict(
		const SemanticGraph& query, const SemanticGraph& target, const GraphIndex& index) const;
	/** What to say of the places that were proposed, best first, among all that were found. */
	void judge(
		const SemanticGraph& query, const GraphIndex& target, const PlaceSearch& search,
		const Places& places, const std::vector<Place>& proposed, bool hasPrior,
		LoopVerdict& verdict) const;

	PlaceRecognizerOptions options_;
	LabelAgreement labelAgreement_;
	GraphMatcher::Ptr matcher_;  //!< null: pairwise
};

}  // namespace semloop
