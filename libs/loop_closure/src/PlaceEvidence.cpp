#include "PlaceEvidence.h"

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
constexpr double kSupportSigma = 0.15;   // [m]
constexpr double kSupportReach = 12;     // squared, in sigmas
constexpr double kReach = 1.2;           // of a match, whatever the sigma [m]
constexpr std::size_t kShortList = 24;   // looked through faster than searched
constexpr double kHeightOfPlaces = 1.0;  // range of the unknown z of two worlds [m]
constexpr double kLeastRadius = 0.1;     // of matches [m]
constexpr double kNearPrior = 5;         // [sigmas]
constexpr int kSigmas = 6;
constexpr int kMaxSteps = 4;
// The first steps from two matches to a pose: far ones may still come in.
constexpr double kFirstSigmas[] = {0.2, 0.1};
constexpr double kWide = 9;  // squared ratio of the two normal distributions' sigmas

/** Of a pair whose objects were not seen all round. */
double widened(double sigma, double variance)
{
	return variance > 0 ? std::sqrt(sigma * sigma + variance) : sigma;
}

/** The mixture of both distributions over exp(-d / (2 kWide)), d the squared distance in sigmas: the wide
 *  one's share of it is then constant, and nothing underflows that decides. */
double overWide(double d, double badShare)
{
	return (1 - badShare) * std::exp(-0.5 * d * (1 - 1 / kWide)) + badShare / 27;
}
}  // namespace

PoseDensity::PoseDensity(
	const MatchCandidates& candidates, double area, double doubt,
	const std::optional<PosePrior>& prior)
	: centroid_(candidates.centroid()), uniform_(1 / (area * kHeightOfPlaces * 2 * M_PI))
{
	most_ = std::log(uniform_);
	if (!prior) return;
	prior_ = *prior;
	expected_ = prior_.T_target_query.composePoint(centroid_);
	yaw_ = prior_.T_target_query.yaw();
	peak_ =
		(1 - doubt) / (mrpt::square(2 * M_PI * prior_.sigmaXY) * prior_.sigmaZ * prior_.sigmaYaw);
	if (peak_ < uniform_)  // wider than the map: it says nothing
	{
		peak_ = 0;
		return;
	}
	uniform_ *= doubt;
	most_ = std::log(peak_ + uniform_);
}

double PoseDensity::turnToPrior(const YawPose& pose) const
{
	return std::remainder(yaw_ - std::atan2(pose.sine, pose.cosine), 2 * M_PI);
}

double PoseDensity::sigmas(const YawPose& pose) const
{
	if (peak_ == 0) return 0;
	const auto d = pose * centroid_ - expected_;
	return std::sqrt(
		(d.x * d.x + d.y * d.y) / mrpt::square(prior_.sigmaXY) + mrpt::square(d.z / prior_.sigmaZ) +
		mrpt::square(turnToPrior(pose) / prior_.sigmaYaw));
}

double PoseDensity::log(const YawPose& pose) const
{
	if (peak_ == 0) return most_;
	return std::log(peak_ * std::exp(-0.5 * mrpt::square(sigmas(pose))) + uniform_);
}

YawPose PoseDensity::withPriorsYaw(
	const YawPose& pose, const mrpt::math::TPoint3D& pivot, double& yawSigma) const
{
	if (peak_ == 0 || sigmas(pose) > kNearPrior) return pose;
	const double variance = yawSigma * yawSigma, priors = prior_.sigmaYaw * prior_.sigmaYaw;
	const double yaw =
		std::atan2(pose.sine, pose.cosine) + turnToPrior(pose) * variance / (variance + priors);
	yawSigma = std::sqrt(variance * priors / (variance + priors));
	return YawPose::about(pivot, pose * pivot, std::cos(yaw), std::sin(yaw));
}

PlaceEvidence::PlaceEvidence(
	const MatchCandidates& candidates, std::size_t targets, const PoseDensity& density,
	const PlaceSearchOptions& options)
	: candidates_(candidates),
	  density_(density),
	  options_(options),
	  logOdds_(
		  std::log(options.reobservedShare / (1 - options.reobservedShare)) +
		  std::log(candidates.volume()) - 1.5 * std::log(2 * M_PI)),
	  usedQuery_(candidates.size(), 0),
	  usedTarget_(targets, 0)
{
	const double step = std::pow(options.maxSigma / options.minSigma, 1.0 / (kSigmas - 1));
	for (double sigma = options.minSigma; int(sigmas_.size()) < kSigmas; sigma *= step)
		sigmas_.push_back(sigma);
	for (std::size_t j = 0; j < candidates.size(); ++j)
		mostSupport_.push_back(float(std::max(0.0, supportBase() + candidates.bestWeight(j))));
}

double PlaceEvidence::mostSupport(const std::vector<std::size_t>& queries) const
{
	double sum = 0;
	for (const std::size_t j : queries) sum += double(mostSupport_[j]);
	return sum;
}

double PlaceEvidence::support(
	const YawPose& pose, const std::vector<std::size_t>& queries, double most, double least) const
{
	constexpr auto inverse = float(1 / (kSupportSigma * kSupportSigma));
	static const double reach = kSupportSigma * std::sqrt(kSupportReach);
	const auto base = float(supportBase());
	auto sum = float(most);
	for (const std::size_t j : queries)
	{
		const auto& all = candidates_.of(j);
		const auto p = pose * candidates_.point(j);
		const auto* begin = all.data();
		const auto* end = begin + all.size();
		if (all.size() > kShortList)
			std::tie(begin, end) = MatchCandidates::range(all, p.x - reach, p.x + reach);
		const auto x = float(p.x), y = float(p.y), z = float(p.z);
		float best = 0;
		for (const auto* c = begin; c != end; ++c)
		{
			const float dx = c->x - x, dy = c->y - y, dz = c->z - z;
			const float squared = (dx * dx + dy * dy + dz * dz) * inverse;
			if (squared < float(kSupportReach))
				best = std::max(best, base + c->weight - 0.5f * squared);
		}
		work_ += end - begin;
		sum -= mostSupport_[j] - best;
		if (double(sum) < least) break;
	}
	return double(sum);
}

double PlaceEvidence::supportBase() const
{
	return logOdds_ - 3 * std::log(kSupportSigma);
}

double PlaceEvidence::logKernel(double squaredDistance, double sigma) const
{
	const double d = squaredDistance / (sigma * sigma);
	return logOdds_ - 0.5 * d / kWide +
		   std::log(overWide(d, options_.badCentreShare) / (sigma * sigma * sigma));
}

/** All that are near enough under the pose. */
void PlaceEvidence::findPairs(const YawPose& pose)
{
	pairs_.clear();
	for (std::size_t j = 0; j < candidates_.size(); ++j)
	{
		const auto& all = candidates_.of(j);
		if (all.empty()) continue;
		const auto p = pose * candidates_.point(j);
		const auto* begin = all.data();
		const auto* end = begin + all.size();
		if (all.size() > kShortList)
			std::tie(begin, end) = MatchCandidates::range(all, p.x - kReach, p.x + kReach);
		for (const auto* c = begin; c != end; ++c)
		{
			const double squared = mrpt::square(double(c->x) - p.x) +
								   mrpt::square(double(c->y) - p.y) +
								   mrpt::square(double(c->z) - p.z);
			if (squared < kReach * kReach)
				pairs_.push_back(
					{j,
					 c->target,
					 squared,
					 double(c->weight),
					 double(c->variance),
					 {double(c->x), double(c->y), double(c->z)}});
		}
	}
}

/** One to one, what says most first. */
void PlaceEvidence::match(double sigma)
{
	ranked_.clear();
	for (std::size_t i = 0; i < pairs_.size(); ++i)
	{
		const double value =
			pairs_[i].weight +
			logKernel(pairs_[i].squaredDistance, widened(sigma, pairs_[i].variance));
		if (value > 0) ranked_.emplace_back(-value, i);
	}
	std::sort(ranked_.begin(), ranked_.end());
	++call_;
	matched_.clear();
	matchedEvidence_ = 0;
	for (const auto& [value, i] : ranked_)
	{
		const Pair& pair = pairs_[i];
		if (usedQuery_[pair.query] == call_ || usedTarget_[pair.target] == call_) continue;
		usedQuery_[pair.query] = usedTarget_[pair.target] = call_;
		matched_.push_back(i);
		matchedEvidence_ -= value;
	}
}

double PlaceEvidence::evidence(const YawPose& pose, double sigma) const
{
	const auto count = double(matched_.size());
	if (count < 2) return Hypothesis().evidence;
	return matchedEvidence_ + density_.log(pose) +
		   std::log(mrpt::square(2 * M_PI / count) * std::pow(sigma, 4) / radius());
}

double PlaceEvidence::radius() const
{
	const auto count = double(matched_.size());
	mrpt::math::TPoint3D mean;
	for (const std::size_t i : matched_) mean += candidates_.point(pairs_[i].query);
	mean *= 1 / count;
	double spread = 0;
	for (const std::size_t i : matched_)
	{
		const auto d = candidates_.point(pairs_[i].query) - mean;
		spread += d.x * d.x + d.y * d.y;
	}
	return std::sqrt(std::max(spread / count, kLeastRadius * kLeastRadius));
}

/** Least squares over the matches, those that the wide distribution explains weighing less. */
std::optional<YawPose> PlaceEvidence::fit(double sigma) const
{
	std::vector<WeightedPair> pairs;
	pairs.reserve(matched_.size());
	for (const std::size_t i : matched_)
	{
		const double own = widened(sigma, pairs_[i].variance);
		const double d = pairs_[i].squaredDistance / (own * own);
		const double wide = options_.badCentreShare / 27;
		const double all = overWide(d, options_.badCentreShare);
		pairs.push_back(
			{candidates_.point(pairs_[i].query), pairs_[i].point,
			 (all - wide + wide / kWide) / all * mrpt::square(sigma / own)});
	}
	return fitYawPose(pairs);
}

std::vector<Match> PlaceEvidence::matches() const
{
	std::vector<Match> result;
	for (const std::size_t i : matched_) result.push_back({pairs_[i].query, pairs_[i].target});
	std::sort(
		result.begin(), result.end(),
		[](const Match& a, const Match& b) { return a.query < b.query; });
	return result;
}

Hypothesis PlaceEvidence::refine(const YawPose& start)
{
	Hypothesis best;
	best.pose = start;
	findPairs(best.pose);
	const auto climb = [&](double sigma, int steps)
	{
		std::vector<Match> before;
		for (int step = 0; step < steps; ++step)
		{
			match(sigma);
			auto now = matches();
			const auto fitted = fit(sigma);
			if (!fitted || now == before) return;
			before = std::move(now);
			best.pose = *fitted;
			findPairs(best.pose);
		}
	};
	for (const double sigma : kFirstSigmas) climb(sigma, kMaxSteps);
	const auto takeBestSigma = [&]
	{
		best.evidence = Hypothesis().evidence;
		for (const double sigma : sigmas_)
		{
			match(sigma);
			const double value = evidence(best.pose, sigma);
			if (value <= best.evidence) continue;
			best.evidence = value;
			best.sigma = sigma;
			best.yawSigma = sigma / (radius() * std::sqrt(double(matched_.size())));
			best.matches = matches();
		}
	};
	takeBestSigma();
	if (best.matches.size() < 2) return best;
	climb(best.sigma, 2);
	takeBestSigma();
	return best;
}

}  // namespace semloop
