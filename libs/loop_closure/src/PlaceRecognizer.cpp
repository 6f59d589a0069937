#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/config/ModuleFactory.h>
#include <semloop/loop_closure/PlaceRecognizer.h>
#include <semloop/loop_closure/YawPose.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace semloop
{
namespace
{
using Decision = LoopVerdict::Decision;

struct NamedMatcher
{
	const char *name, *className;
};
// None, or the class of a GraphMatcher.
constexpr const char *kPairwise = "pairwise", *kPublished = "spectral";
constexpr NamedMatcher kMatchers[] = {
	{kPairwise, nullptr},
	{"spectral-verified", "semloop::SpectralMatcher"},
	{"clique", "semloop::CliqueMatcher"},
	{"random-walk", "semloop::RandomWalkMatcher"},
	{"histogram", "semloop::HistogramMatcher"},
	{kPublished, "semloop::SpectralMatcher"}};
// Sec. IV-B
constexpr double kPublishedEdgeShare = 0.5;
constexpr double kEdgeLengthTolerance = 0.5;  // [m]

std::vector<std::pair<ObjectId, ObjectId>> idsOf(
	const std::vector<Match>& matches, const SemanticGraph& query, const GraphIndex& target)
{
	std::vector<std::pair<ObjectId, ObjectId>> ids;
	for (const auto& [j, k] : matches) ids.emplace_back(query.vertices[j].id, target.id(k));
	return ids;
}

void requireUsable(const PosePrior& prior)
{
	for (const double sigma : {prior.sigmaXY, prior.sigmaZ, prior.sigmaYaw})
		if (!std::isfinite(sigma) || sigma <= 0)
			throw InputError(mrpt::format(
				"prior: its standard deviations are %g m, %g m and %g rad; they must be finite and "
				"above 0",
				prior.sigmaXY, prior.sigmaZ, prior.sigmaYaw));
	const auto& T = prior.T_target_query;
	if (!std::isfinite(T.x() + T.y() + T.z() + T.yaw()))
		throw InputError("prior: its pose is not finite");
}

/** Of the matched centres [m]. */
double rmseOf(
	const SemanticGraph& query, const GraphIndex& target, const std::vector<Match>& matches,
	const mrpt::poses::CPose3D& T_target_query)
{
	double sum = 0;
	for (const auto& [j, k] : matches)
		sum +=
			(T_target_query.composePoint(query.vertices[j].position) - target.point(k)).sqrNorm();
	return std::sqrt(sum / double(std::max<std::size_t>(1, matches.size())));
}

std::optional<LoopVerdict> tooSmall(const SemanticGraph& query, const GraphIndex& target)
{
	if (query.vertices.size() >= 2 && target.size() >= 2) return {};
	LoopVerdict verdict;
	verdict.queryObjects = query.vertices.size();
	verdict.reason = mrpt::format(
		"%zu objects against %zu: a place needs two on either side", query.vertices.size(),
		target.size());
	return verdict;
}

void reweigh(
	Places& places, const PlaceSearch& search, const GraphIndex& target, const PosePrior& prior,
	const PriorOfObjects& priorOf)
{
	for (Place& place : places.found)
	{
		std::vector<ObjectId> ids;
		for (const auto& match : place.matches) ids.push_back(target.id(match.target));
		place = search.reweighed(std::move(place), prior, priorOf(ids));
	}
	std::stable_sort(
		places.found.begin(), places.found.end(),
		[](const Place& a, const Place& b) { return a.evidence > b.evidence; });
}

/** Those that are not this one. */
std::vector<Place> rivalsOf(
	const Place& place, std::vector<Place> places, const PlaceSearch& search, double rivalDistance)
{
	places.erase(
		std::remove_if(
			places.begin(), places.end(),
			[&](const Place& other) {
				return search.distance(other.T_target_query, place.T_target_query) < rivalDistance;
			}),
		places.end());
	return places;
}
}  // namespace

void PlaceRecognizerOptions::describe(OptionFields& fields)
{
	std::string names;
	for (const auto& known : kMatchers) names += std::string(known.name) + ", ";
	fields.text(
		"matcher", matcher,
		"what proposes places: " + names + "or the class name of another graph matcher");
	fields.number("min_probability", minProbability, 0.5, 1, "of an accepted place to be right");
	fields.integer("min_matches", minMatches, 2, 1000, "objects that an accepted place has");
	fields.degrees(
		"max_yaw_sigma_deg", maxYawSigma, 0.01, 360,
		"standard deviation of an accepted place's yaw [deg]");
	fields.number(
		"max_prior_sigmas", maxPriorSigmas, 0, 1000,
		"distance of an accepted place from the prior [standard deviations]; 0: any");
	search.describe(fields);
}

void PlaceRecognizerOptions::requireConsistent() const
{
	search.requireConsistent();
}

std::vector<std::string> PlaceRecognizer::matcherNames()
{
	std::vector<std::string> names;
	for (const auto& matcher : kMatchers) names.push_back(matcher.name);
	return names;
}

PlaceRecognizer::PlaceRecognizer(const PlaceRecognizerOptions& options, const std::string& key)
	: options_(options), labelAgreement_(options.search.labelAccuracy)
{
	std::string names;
	for (const auto& matcher : kMatchers)
	{
		if (options.matcher == matcher.name)
		{
			if (matcher.className) matcher_ = makeModule<GraphMatcher>(matcher.className, key);
			return;
		}
		names += (names.empty() ? "" : ", ") + std::string(matcher.name);
	}
	try
	{
		matcher_ = makeModule<GraphMatcher>(options.matcher, key);
	}
	catch (const UsageError& error)
	{
		throw UsageError(error.what() + ("; or use one of " + names));
	}
}

void PlaceRecognizer::configureMatcher(
	const mrpt::config::CConfigFileBase& config, const std::string& section)
{
	if (matcher_) matcher_->configure(config, section);
}

void PlaceRecognizer::setConfusionMatrix(const ConfusionMatrix& confusion)
{
	labelAgreement_ = LabelAgreement(options_.search.labelAccuracy, confusion);
}

LoopVerdict PlaceRecognizer::publishedVerdict(
	const SemanticGraph& query, const SemanticGraph& target, const GraphIndex& index) const
{
	LoopVerdict verdict;
	verdict.queryObjects = query.vertices.size();
	const auto matching = matcher_->match(query, target);
	verdict.matches = idsOf(matching.matches, query, index);
	verdict.candidates = verdict.matches;
	verdict.matchingScore = matching.score;
	const double edgeShare =
		matchedEdgeShare(query, target, matching.matches, kEdgeLengthTolerance);
	verdict.matchedEdgeShare = edgeShare;
	std::vector<WeightedPair> pairs;
	for (const auto& [j, k] : matching.matches)
		pairs.push_back({query.vertices[j].position, index.point(k)});
	const auto pose = fitYawPose(pairs);
	verdict.hasPose = pose.has_value();
	if (pose)
	{
		verdict.T_target_query = pose->toPose3D();
		verdict.centreRmse = rmseOf(query, index, matching.matches, verdict.T_target_query);
	}
	verdict.reason = mrpt::format(
		"%.0f %% of the %zu edges matched, needed are %.0f %%", 100 * edgeShare, query.edges.size(),
		100 * kPublishedEdgeShare);
	verdict.graphsMatch = edgeShare >= kPublishedEdgeShare;
	if (!verdict.graphsMatch) return verdict;
	if (pose)
		verdict.decision = Decision::Accepted;
	else
		verdict.reason += ", but they leave the pose open: a horizontal distance is needed";
	return verdict;
}

LoopVerdict PlaceRecognizer::recognize(
	const SemanticGraph& query, const SemanticGraph& target, const GraphIndex& targetIndex,
	const std::optional<PosePrior>& prior) const
{
	if (!needsTargetGraph()) return recognize(query, targetIndex, prior);
	if (prior) requireUsable(*prior);
	if (const auto verdict = tooSmall(query, targetIndex)) return *verdict;
	if (options_.matcher == kPublished) return publishedVerdict(query, target, targetIndex);

	LoopVerdict verdict;
	verdict.queryObjects = query.vertices.size();
	const PlaceSearch search(query, targetIndex, labelAgreement_, options_.search);
	const auto matching = matcher_->match(query, target);
	verdict.matchingScore = matching.score;
	judge(
		query, targetIndex, search, search.places(prior),
		search.placesOf(matching.matches, prior).found, prior.has_value(), verdict);
	return verdict;
}

LoopVerdict PlaceRecognizer::recognize(
	const SemanticGraph& query, const GraphIndex& target, const std::optional<PosePrior>& prior,
	const PriorOfObjects& priorOf) const
{
	if (needsTargetGraph())
		throw std::logic_error("place recognition: " + options_.matcher + " needs the graph");
	if (prior) requireUsable(*prior);
	if (const auto verdict = tooSmall(query, target)) return *verdict;
	LoopVerdict verdict;
	verdict.queryObjects = query.vertices.size();
	const PlaceSearch search(query, target, labelAgreement_, options_.search);
	auto places = search.places(prior);
	if (prior && priorOf) reweigh(places, search, target, *prior, priorOf);
	judge(query, target, search, places, places.found, prior.has_value(), verdict);
	return verdict;
}

void PlaceRecognizer::judge(
	const SemanticGraph& query, const GraphIndex& target, const PlaceSearch& search,
	const Places& places, const std::vector<Place>& proposed, bool hasPrior,
	LoopVerdict& verdict) const
{
	if (proposed.empty())
	{
		verdict.reason = mrpt::format(
			"no two of the %zu objects are in the map at their distance%s", query.vertices.size(),
			hasPrior ? " and where the prior allows" : "");
		return;
	}

	const Place& best = proposed.front();
	const auto rivals = rivalsOf(best, places.found, search, options_.search.rivalDistance);
	verdict.matches = idsOf(best.matches, query, target);
	verdict.candidates = verdict.matches;
	verdict.hasPose = true;
	verdict.T_target_query = best.T_target_query;
	verdict.evidence = best.evidence;
	verdict.centreRmse = rmseOf(query, target, best.matches, best.T_target_query);
	verdict.probability = probabilityOf(best, query.vertices.size(), rivals, options_.search);
	const bool hasRival = !rivals.empty() && best.evidence > 0;
	verdict.runnerUp =
		hasRival ? std::clamp(rivals.front().evidence / best.evidence, 0.0, 1.0) : 0.0;
	verdict.reason = mrpt::format(
		"%zu of %zu objects fit one place (within %.2f m, evidence %.1f), the best other place has "
		"%.1f: probability %.3f",
		best.matches.size(), query.vertices.size(), best.sigma, best.evidence,
		rivals.empty() ? 0.0 : rivals.front().evidence, verdict.probability);

	if (int(best.matches.size()) < options_.minMatches)
		verdict.reason += mrpt::format(", needed are %d objects", options_.minMatches);
	else if (options_.maxPriorSigmas > 0 && best.priorSigmas > options_.maxPriorSigmas)
		verdict.reason += mrpt::format(
			", but it is %.1f standard deviations from the prior, allowed are %.1f",
			best.priorSigmas, options_.maxPriorSigmas);
	else if (verdict.probability >= options_.minProbability && !places.complete)
	{
		verdict.decision = Decision::Ambiguous;
		verdict.reason += ", but too many objects look alike to try every place";
	}
	else if (verdict.probability >= options_.minProbability && best.yawSigma > options_.maxYawSigma)
	{
		verdict.decision = Decision::Ambiguous;
		verdict.reason += mrpt::format(
			", but its yaw is uncertain by %.2f rad, allowed are %.2f", best.yawSigma,
			options_.maxYawSigma);
	}
	else if (verdict.probability >= options_.minProbability)
		verdict.decision = Decision::Accepted;
	else if (
		probabilityOf(best, query.vertices.size(), {}, options_.search) >= options_.minProbability)
		verdict.decision = Decision::Ambiguous;
	else
		verdict.reason += mrpt::format(", needed is %.2f", options_.minProbability);
	verdict.graphsMatch = verdict.decision == Decision::Accepted;
}

}  // namespace semloop
