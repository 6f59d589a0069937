#include <semloop/loop_closure/PlaceSearch.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "MatchCandidates.h"
#include "PlaceEvidence.h"
#include "Shortlist.h"

namespace semloop
{
namespace
{
using mrpt::math::TPoint3D;

constexpr double kMinBaseline = 0.25;    // horizontal, below it two centres do not tell the yaw [m]
constexpr double kHorizontalGate = 0.6;  // difference of two distances, four times 0.15 [m]
constexpr double kVerticalGate = 0.45;   // three times 0.15 [m]
constexpr std::size_t kAllPairsUpTo = 16;  // objects of the query
constexpr double kWorkForAllPairs = 2e6;   // pairs of candidates
constexpr std::size_t kGroupSize = 4;
// Candidates looked at. Thousands of objects that all look alike must not take for ever: a few seconds.
constexpr std::ptrdiff_t kMostWork = 200'000'000;

double horizontalDistance(const TPoint3D& a, const TPoint3D& b)
{
	return std::sqrt(mrpt::square(a.x - b.x) + mrpt::square(a.y - b.y));
}

/** lengthQ is the horizontal distance of the first two. Empty when the distances disagree or leave the yaw
 *  open. */
std::optional<YawPose> poseOfTwo(
	const TPoint3D& q1, const TPoint3D& q2, double lengthQ, const TPoint3D& t1, const TPoint3D& t2)
{
	const auto dq = q2 - q1, dt = t2 - t1;
	if (lengthQ < kMinBaseline) return {};
	if (std::abs(dq.z - dt.z) > kVerticalGate) return {};
	const double squaredT = dt.x * dt.x + dt.y * dt.y;
	if (squaredT > mrpt::square(lengthQ + kHorizontalGate) ||
		squaredT < mrpt::square(std::max(kMinBaseline, lengthQ - kHorizontalGate)))
		return {};
	return YawPose::about(
		(q1 + q2) * 0.5, (t1 + t2) * 0.5, dq.x * dt.x + dq.y * dt.y, dq.x * dt.y - dq.y * dt.x);
}

TPoint3D pointOf(const MatchCandidates::Candidate& c)
{
	return {double(c.x), double(c.y), double(c.z)};
}
}  // namespace

class PlaceSearch::Impl
{
public:
	Impl(
		const SemanticGraph& query, const GraphIndex& itsTarget, const LabelAgreement& agreement,
		const PlaceSearchOptions& itsOptions)
		: options(itsOptions), target(itsTarget), candidates(query, target, agreement, options)
	{
		for (std::size_t j = 0; j < candidates.size(); ++j)
			if (!candidates.of(j).empty()) probes.push_back(j);
		// Few candidates make few poses.
		std::stable_sort(
			probes.begin(), probes.end(),
			[&](std::size_t a, std::size_t b)
			{ return candidates.of(a).size() < candidates.of(b).size(); });
		const auto end = probes.begin() + std::ptrdiff_t(std::min(probes.size(), kAllPairsUpTo));
		others.assign(end, probes.end());
		probes.erase(end, probes.end());
		makePairs();
	}

	const PlaceSearchOptions options;
	const GraphIndex& target;
	const MatchCandidates candidates;
	/** Objects with candidates; pairs are made of the probes. */
	std::vector<std::size_t> probes, others;
	std::vector<std::pair<std::size_t, std::size_t>> pairs;  //!< that propose poses

private:
	/** All, or in a large map those within groups of four probes: of more objects of one place than there are
	 *  groups two are in one. A group has objects at different distances from the centroid, for a short pair
	 *  tells little of the yaw, and a query that is turned has the same groups. */
	void makePairs()
	{
		double work = 0;
		for (std::size_t a = 0; a < probes.size(); ++a)
			for (std::size_t b = a + 1; b < probes.size(); ++b)
			{
				pairs.emplace_back(probes[a], probes[b]);
				work += double(candidates.of(probes[a]).size()) *
						double(candidates.of(probes[b]).size());
			}
		const std::size_t groups = probes.size() / kGroupSize;
		if (work < kWorkForAllPairs || groups < 2) return;
		auto byPlace = probes;
		std::stable_sort(
			byPlace.begin(), byPlace.end(),
			[&](std::size_t a, std::size_t b)
			{
				return horizontalDistance(candidates.point(a), candidates.centroid()) <
					   horizontalDistance(candidates.point(b), candidates.centroid());
			});
		std::vector<std::size_t> group(candidates.size());
		for (std::size_t i = 0; i < byPlace.size(); ++i) group[byPlace[i]] = i % groups;
		pairs.erase(
			std::remove_if(
				pairs.begin(), pairs.end(),
				[&](const auto& pair) { return group[pair.first] != group[pair.second]; }),
			pairs.end());
	}
};

namespace
{
/** One search, with or without a prior. */
class Search
{
public:
	Search(const PlaceSearch::Impl& impl, const std::optional<PosePrior>& prior)
		: impl_(impl),
		  density_(impl.candidates, impl.target.area(), impl.options.priorDoubt, prior),
		  evidence_(impl.candidates, impl.target.size(), density_, impl.options),
		  shortlist_(impl.candidates),
		  probesMost_(evidence_.mostSupport(impl.probes)),
		  othersMost_(evidence_.mostSupport(impl.others))
	{
	}

	/** Two objects and all that they may be. */
	void tryAll()
	{
		for (const auto& [a, b] : impl_.pairs) tryAll(a, b);
	}

	void tryPairsOf(const std::vector<Match>& matches)
	{
		const auto& query = impl_.candidates;
		for (std::size_t a = 0; a < matches.size() && hasTime(); ++a)
			for (std::size_t b = a + 1; b < matches.size(); ++b)
			{
				++pairs_;
				const auto &q1 = query.point(matches[a].query), &q2 = query.point(matches[b].query);
				if (const auto pose = poseOfTwo(
						q1, q2, horizontalDistance(q1, q2), impl_.target.point(matches[a].target),
						impl_.target.point(matches[b].target)))
					propose(*pose);
			}
	}

	/** Of what was tried. */
	Places best()
	{
		std::vector<Hypothesis> all;
		for (const auto& proposal : shortlist_.proposals())
			if (auto refined = evidence_.refine(proposal.pose); refined.matches.size() >= 2)
				all.push_back(std::move(refined));
		std::stable_sort(
			all.begin(), all.end(),
			[](const auto& a, const auto& b) { return a.evidence > b.evidence; });
		std::vector<YawPose> poses;
		Places places;
		places.complete = hasTime();
		for (auto& hypothesis : all)
		{
			if (std::any_of(
					poses.begin(), poses.end(),
					[&](const YawPose& better) { return isSame(better, hypothesis.pose); }))
				continue;
			poses.push_back(hypothesis.pose);
			TPoint3D pivot;
			for (const auto& match : hypothesis.matches)
				pivot += impl_.candidates.point(match.query);
			pivot *= 1.0 / double(hypothesis.matches.size());
			const auto pose = density_.withPriorsYaw(hypothesis.pose, pivot, hypothesis.yawSigma);
			places.found.push_back(
				{pose.toPose3D(), std::move(hypothesis.matches), hypothesis.evidence,
				 hypothesis.sigma, hypothesis.yawSigma, density_.sigmas(hypothesis.pose)});
		}
		return places;
	}

private:
	void tryAll(std::size_t a, std::size_t b)
	{
		const auto &q1 = impl_.candidates.point(a), &q2 = impl_.candidates.point(b);
		const double length = horizontalDistance(q1, q2);
		if (length < kMinBaseline) return;
		const double reach = length + kHorizontalGate;
		for (const auto& first : impl_.candidates.of(a))
		{
			const auto [begin, end] = MatchCandidates::range(
				impl_.candidates.of(b), double(first.x) - reach, double(first.x) + reach);
			pairs_ += end - begin;
			if (!hasTime()) return;
			for (const auto* second = begin; second != end; ++second)
				if (second->target != first.target)
					if (const auto pose =
							poseOfTwo(q1, q2, length, pointOf(first), pointOf(*second)))
						propose(*pose);
		}
	}

	bool isSame(const YawPose& a, const YawPose& b) const
	{
		return shortlist_.squaredDistance(a, b) < mrpt::square(impl_.options.rivalDistance);
	}

	bool hasTime() const { return pairs_ + evidence_.work() < kMostWork; }

	void propose(const YawPose& pose)
	{
		if (shortlist_.isAtBest(pose)) return;
		const double least = shortlist_.least();
		const bool isSmall = impl_.others.empty();
		// The others will not differ much from the probes.
		const double leastOfProbes = isSmall ? least : 0.5 * mostOfProbes_;
		double support = evidence_.support(pose, impl_.probes, probesMost_, leastOfProbes);
		if (support < leastOfProbes) return;
		if (!isSmall)
		{
			mostOfProbes_ = std::max(mostOfProbes_, support);
			support += evidence_.support(pose, impl_.others, othersMost_, least - support);
			if (support < least) return;
		}
		support += density_.log(pose) - density_.most();
		if (support > 0 && support >= shortlist_.least()) shortlist_.add({pose, support});
	}

	const PlaceSearch::Impl& impl_;
	const PoseDensity density_;
	PlaceEvidence evidence_;
	Shortlist shortlist_;
	const double probesMost_, othersMost_;
	double mostOfProbes_ = 0;   //!< so far
	std::ptrdiff_t pairs_ = 0;  //!< looked at
};

}  // namespace

PlaceSearch::PlaceSearch(
	const SemanticGraph& query, const GraphIndex& target, const PlaceSearchOptions& options)
	: PlaceSearch(query, target, LabelAgreement(options.labelAccuracy), options)
{
}
PlaceSearch::PlaceSearch(
	const SemanticGraph& query, const GraphIndex& target, const LabelAgreement& agreement,
	const PlaceSearchOptions& options)
	: impl_(std::make_unique<Impl>(query, target, agreement, options))
{
}
PlaceSearch::~PlaceSearch() = default;

Places PlaceSearch::places(const std::optional<PosePrior>& prior) const
{
	Search search(*impl_, prior);
	search.tryAll();
	return search.best();
}

Places PlaceSearch::placesOf(
	const std::vector<Match>& matches, const std::optional<PosePrior>& prior) const
{
	Search search(*impl_, prior);
	search.tryPairsOf(matches);
	return search.best();
}

Place PlaceSearch::reweighed(Place place, const PosePrior& before, const PosePrior& now) const
{
	const auto density = [&](const PosePrior& prior) {
		return PoseDensity(
			impl_->candidates, impl_->target.area(), impl_->options.priorDoubt, prior);
	};
	const auto& T = place.T_target_query;
	YawPose pose;
	pose.cosine = std::cos(T.yaw());
	pose.sine = std::sin(T.yaw());
	pose.translation = TPoint3D(T.translation());
	place.evidence += density(now).log(pose) - density(before).log(pose);
	place.priorSigmas = density(now).sigmas(pose);
	return place;
}

double PlaceSearch::distance(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) const
{
	double sum = 0;
	for (std::size_t j = 0; j < impl_->candidates.size(); ++j)
	{
		const auto& p = impl_->candidates.point(j);
		sum += (a.composePoint(p) - b.composePoint(p)).sqrNorm();
	}
	return std::sqrt(sum / double(std::max<std::size_t>(1, impl_->candidates.size())));
}

double probabilityOf(
	const Place& place, std::size_t objects, const std::vector<Place>& rivals,
	const PlaceSearchOptions& options)
{
	// ln(1 + sum of e^E), without overflow
	double most = 0, sum = 0;
	for (const auto& rival : rivals) most = std::max(most, rival.evidence);
	for (const auto& rival : rivals) sum += std::exp(rival.evidence - most);
	const double others = most + std::log(sum + std::exp(-most));
	const double share = double(place.matches.size()) / double(std::max<std::size_t>(1, objects));
	const double odds = options.oddsPerEvidence * (place.evidence - others) +
						options.oddsPerShare * share - options.evenOdds;
	return 1 / (1 + std::exp(-odds));
}

}  // namespace semloop
