#include <mrpt/core/format.h>
#include <mrpt/core/initializer.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/loop_closure/SemanticLoopDetector.h>

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
	const CObjectMap& map, const SemanticLoopDetectorOptions& options, LoopVerdict& verdict)
{
	std::vector<std::pair<ObjectId, ObjectId>> matches;
	std::vector<MatchAlignment> alignments;
	double sum = 0;
	for (std::size_t i = 0; i < verdict.matches.size(); ++i)
	{
		const auto& [query, target] = verdict.matches[i];
		const auto error = verdict.T_target_query.composePoint(map.object(query).centre()) -
						   map.object(target).centre();
		const double variance =
			ObjectAligner::centreVariance(map.object(query), map.object(target));
		const auto widened = [&](double limit) { return std::sqrt(limit * limit + variance); };
		if (std::hypot(error.x, error.y) > widened(options.maxHorizontalError) ||
			std::abs(error.z) > widened(options.maxVerticalError))
			continue;
		matches.push_back(verdict.matches[i]);
		alignments.push_back(verdict.alignments[i]);
		sum += error.sqrNorm();
	}
	verdict.centreRmse.reset();
	if (!matches.empty()) verdict.centreRmse = std::sqrt(sum / double(matches.size()));
	verdict.matches = std::move(matches);
	verdict.alignments = std::move(alignments);
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
	fields.integer(
		"min_observations", minObservations, 1, 1000000,
		"objects that were seen in fewer frames stay out of the graphs");
	recognition.describe(fields);
	fields.number(
		"max_horizontal_error", maxHorizontalError, 0.001, 10,
		"horizontal distance of matched centres when the surfaces are aligned [m]");
	fields.number("max_vertical_error", maxVerticalError, 0.001, 10, "vertical, same [m]");
}

void SemanticLoopDetectorOptions::requireConsistent() const
{
	recognition.requireConsistent();
}

SemanticLoopDetector::SemanticLoopDetector(const SemanticLoopDetectorOptions& options)
	: options_(options), recognizer_(options.recognition)
{
}

void SemanticLoopDetector::configure(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	options_.loadFromConfigFile(config, section);
	recognizer_ = PlaceRecognizer(
		options_.recognition, configFileName(config) + ": [" + section + "] matcher");
	recognizer_.configureMatcher(config, kMatcherSection);
	aligner.configure(config, kAlignerSection);
}

LoopVerdict SemanticLoopDetector::detect(const LoopQuery& query)
{
	const CObjectMap& map = query.map;
	LoopVerdict verdict;
	const auto queryGraph = SemanticGraph::fromMap(map, query.query, options_.minObservations);
	try
	{
		if (recognizer_.needsTargetGraph())
		{
			const auto target = SemanticGraph::fromMap(map, query.target, options_.minObservations);
			verdict = recognizer_.recognize(queryGraph, target, GraphIndex(target), query.prior);
		}
		else
			verdict = recognizer_.recognize(
				queryGraph, target_.update(map, query.target, options_.minObservations),
				query.prior, query.priorOf);
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
	const std::size_t matched = verdict.matches.size();
	dropWhatTheSurfacesRefute(map, options_, verdict);
	const std::size_t left = verdict.matches.size();
	if (int(left) < options_.recognition.minMatches || 2 * left < matched)
		return reject(
			verdict, verdict.reason +
						 mrpt::format("; but under the pose of the surfaces only %zu do", left));
	verdict.reason += mrpt::format("; %zu of them where ", left) + alignment.reason;
	return verdict;
}

}  // namespace semloop
