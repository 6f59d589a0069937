#include <mrpt/core/format.h>
#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/loop_closure/SemanticLoopDetector.h>
#include <semloop/loop_closure/SpectralMatcher.h>

#include <algorithm>
#include <cmath>

IMPLEMENTS_MRPT_OBJECT(SemanticLoopDetector, LoopDetector, semloop)

MRPT_INITIALIZER(registerSemanticLoopDetector)
{
	mrpt::rtti::registerClass(CLASS_ID(semloop::SemanticLoopDetector));
}

namespace semloop
{
namespace
{
using Decision = LoopVerdict::Decision;

constexpr const char* kMatcherSection = "graph_matching";
constexpr const char* kAlignerSection = "alignment";

/** Neighbours that were taken for each other fit the centres, not the surfaces of the others. */
void dropWhatTheSurfacesRefute(
	const CObjectMap& map, const GeometricVerificationOptions& options, LoopVerdict& verdict)
{
	std::vector<std::pair<ObjectId, ObjectId>> matches;
	std::vector<MatchAlignment> alignments;
	double sum = 0;
	for (std::size_t i = 0; i < verdict.matches.size(); ++i)
	{
		const auto& [query, target] = verdict.matches[i];
		const auto error = verdict.T_target_query.composePoint(map.object(query).centre()) -
						   map.object(target).centre();
		if (std::hypot(error.x, error.y) > options.maxHorizontalError ||
			std::abs(error.z) > options.maxVerticalError)
			continue;
		matches.push_back(verdict.matches[i]);
		alignments.push_back(verdict.alignments[i]);
		sum += error.sqrNorm();
	}
	verdict.centreRmse = matches.empty() ? 0.0 : std::sqrt(sum / double(matches.size()));
	verdict.matches = std::move(matches);
	verdict.alignments = std::move(alignments);
}

double leastInliers(const SemanticGraph& query, const GeometricVerificationOptions& options)
{
	return std::max<double>(
		options.minInliers, options.minInlierShare * static_cast<double>(query.vertices.size()));
}

LoopVerdict& reject(LoopVerdict& verdict, std::string reason)
{
	verdict.decision = Decision::Rejected;
	verdict.reason = std::move(reason);
	return verdict;
}
}  // namespace

void SemanticLoopDetectorOptions::describe(OptionFields& fields)
{
	fields.text("matcher", matcher, "class name of the graph matcher");
	fields.integer(
		"min_observations", minObservations, 1, 1000000,
		"objects that were seen in fewer frames stay out of the graphs");
	fields.number(
		"min_edge_share", minEdgeShare, 0, 1, "matched edges / edges of the query, Sec. IV-B");
	fields.number(
		"edge_length_tolerance", edgeLengthTolerance, 0, 100,
		"difference of the lengths of a matched edge [m]");
	verification.describe(fields);
}

SemanticLoopDetector::SemanticLoopDetector() : matcher_(SpectralMatcher::Create()) {}

void SemanticLoopDetector::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options.loadFromConfigFile(config, section);
	matcher_ = makeModule<GraphMatcher>(
		options.matcher, configFileName(config) + ": [" + section + "] matcher");
	matcher_->configure(config, kMatcherSection);
	aligner.configure(config, kAlignerSection);
}

LoopVerdict SemanticLoopDetector::detect(
	const SemanticGraph& query, const SemanticGraph& target) const
{
	LoopVerdict verdict;
	verdict.queryObjects = query.vertices.size();
	if (query.vertices.empty() || target.vertices.empty())
		return reject(
			verdict, mrpt::format(
						 "%zu objects against %zu: nothing to match", query.vertices.size(),
						 target.vertices.size()));

	// Sec. III-C, Eq. (4)-(6)
	const auto matching = matcher_->match(query, target);
	for (const auto& [j, k] : matching.matches)
		verdict.candidates.emplace_back(query.vertices[j].id, target.vertices[k].id);
	verdict.matchingScore = matching.score;

	// Sec. IV-B: a loop needs half of the query's edges
	verdict.matchedEdgeShare =
		matchedEdgeShare(query, target, matching.matches, options.edgeLengthTolerance);
	if (verdict.matchedEdgeShare < options.minEdgeShare)
		return reject(
			verdict,
			mrpt::format(
				"only %.0f %% of the %zu edges matched, needed are %.0f %%",
				100 * verdict.matchedEdgeShare, query.edges.size(), 100 * options.minEdgeShare));

	verdict.graphsMatch = true;
	const auto check = verifyGeometry(query, target, matching.matches, options.verification);
	for (const auto& [j, k] : check.inliers)
		verdict.matches.emplace_back(query.vertices[j].id, target.vertices[k].id);
	verdict.T_target_query = check.T_target_query;
	verdict.centreRmse = check.rmse;
	verdict.runnerUp = check.runnerUp;
	verdict.reason = check.reason;
	if (check.outcome != GeometricVerification::Outcome::Confirmed)
	{
		if (check.outcome == GeometricVerification::Outcome::Ambiguous)
			verdict.decision = Decision::Ambiguous;
		return verdict;
	}

	verdict.decision = Decision::Accepted;
	return verdict;
}

LoopVerdict SemanticLoopDetector::detect(
	const CObjectMap& map, const std::set<ObjectId>& query, const std::set<ObjectId>& target) const
{
	LoopVerdict verdict;
	const auto queryGraph = SemanticGraph::fromMap(map, query, options.minObservations);
	const auto targetGraph = SemanticGraph::fromMap(map, target, options.minObservations);
	try
	{
		verdict = detect(queryGraph, targetGraph);
	}
	catch (const InputError& error)  // graphs that the matcher cannot take
	{
		verdict.queryObjects = queryGraph.vertices.size();
		return reject(verdict, error.what());
	}
	if (verdict.decision != Decision::Accepted) return verdict;

	// Sec. III-C, Object Alignment
	const auto alignment = aligner.align(map, verdict.matches, verdict.T_target_query);
	verdict.alignmentFitness = alignment.fitness;
	verdict.alignmentRmse = alignment.rmse;
	if (!alignment.accepted) return reject(verdict, verdict.reason + "; but " + alignment.reason);
	verdict.T_target_query = alignment.T_target_query;
	verdict.alignments = alignment.pairs;
	dropWhatTheSurfacesRefute(map, options.verification, verdict);
	const std::size_t left = verdict.matches.size();
	if (static_cast<double>(left) < leastInliers(queryGraph, options.verification))
		return reject(
			verdict, verdict.reason +
						 mrpt::format("; but under the pose of the surfaces only %zu do", left));
	verdict.reason += mrpt::format("; %zu of them where ", left) + alignment.reason;
	return verdict;
}

}  // namespace semloop
