#include "MatchCandidates.h"

#include <semloop/config/Error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace semloop
{
namespace
{
constexpr double kLeastWeight = -1.5;  // what the best place of a single object cannot make up for
constexpr double kLeastSpread = 0.1;   // [m^2]
constexpr double kLeastHeight = 0.5;   // [m]
// Of similarities. Those of one object are seldom worse than kPoorSigma below their usual value.
constexpr float kSameSigma = 0.04f, kPoorSigma = 0.15f, kPoorShare = 0.2f, kLeastSigma = 0.03f;
constexpr std::size_t kFew = 16;          // looked through faster than searched
constexpr std::size_t kEnoughPairs = 10;  // to measure how alike different objects are

float normal(float x, float mean, float sigma)
{
	const float d = (x - mean) / sigma;
	return std::exp(-0.5f * d * d) / sigma;  // the common factor cancels out
}

/** Mean and standard deviation of the similarities of different objects. */
class Spread
{
public:
	Spread(float mean, float sigma) : mean_(mean), sigma_(sigma) {}

	void add(float x)
	{
		++count_;
		sum_ += double(x);
		squares_ += double(x) * double(x);
	}
	/** Until there are enough, the values given at first stay. */
	void finish()
	{
		if (count_ < kEnoughPairs) return;
		const double mean = sum_ / double(count_);
		mean_ = float(mean);
		sigma_ = std::max(
			kLeastSigma, float(std::sqrt(std::max(0.0, squares_ / double(count_) - mean * mean))));
	}
	float density(float x) const { return normal(x, mean_, sigma_); }

private:
	std::size_t count_ = 0;
	double sum_ = 0, squares_ = 0;
	float mean_, sigma_;
};

/** What similarities of embeddings say, learned from those at hand. */
class Looks
{
public:
	Looks(
		const GraphIndex& query, const GraphIndex& target, const std::vector<int>& labels,
		float sameModel)
		: sameModel_(sameModel)
	{
		const auto a = query.embeddings(), b = target.embeddings();
		if (a.size() == 0 || b.size() == 0) return;
		if (a.rows() != b.rows())
			throw InputError(
				"embeddings of " + std::to_string(a.rows()) + " numbers against " +
				std::to_string(b.rows()) + "; describe both maps with one network");
		similarities_.noalias() = b.transpose() * a;
		std::vector<float> best;
		for (Eigen::Index j = 0; j < similarities_.cols(); ++j)
		{
			if (!query.hasEmbedding(std::size_t(j))) continue;
			float most = -1;
			for (Eigen::Index k = 0; k < similarities_.rows(); ++k)
			{
				const float s = similarities_(k, j);
				most = std::max(most, s);
				(target.labelOf(std::size_t(k)) == labels[std::size_t(j)] ? ofLabel_ : ofOthers_)
					.add(s);
			}
			best.push_back(most);
		}
		ofLabel_.finish();
		ofOthers_.finish();
		if (best.empty()) return;
		const auto middle = best.begin() + std::ptrdiff_t(best.size() / 2);
		std::nth_element(best.begin(), middle, best.end());
		usual_ = *middle;
	}

	bool areKnown() const { return similarities_.size() > 0; }
	float similarity(std::size_t query, std::size_t target) const
	{
		return similarities_(Eigen::Index(target), Eigen::Index(query));
	}
	/** Less and two objects of different labels are not one. */
	float leastOfOtherLabel() const { return usual_ - 3 * kSameSigma; }

	/** ln p(s | same) / p(s | different). Some different objects are of one model: it is at most
	 *  -ln(their share). */
	float evidence(float s, bool sameLabel) const
	{
		const float same = (1 - kPoorShare) * normal(s, usual_, kSameSigma) +
						   kPoorShare * normal(s, usual_, kPoorSigma);
		const float different =
			(1 - sameModel_) * (sameLabel ? ofLabel_ : ofOthers_).density(s) + sameModel_ * same;
		return std::log(std::max(same, 1e-6f) / std::max(different, 1e-6f));
	}

private:
	float sameModel_;
	Eigen::MatrixXf similarities_;  //!< a column per object of the query
	Spread ofLabel_{0.5f, 0.2f}, ofOthers_{0.0f, 0.3f};
	float usual_ = 1;
};

/** What labels say: p(z_j | z_k) / p(z_j) for the distributions z over labels of two objects, p(l) their
 *  share in the map. Linear in both distributions. */
class LabelRatios
{
public:
	LabelRatios(const GraphIndex& query, const GraphIndex& target, const LabelAgreement& agreement)
		: query_(query)
	{
		const std::size_t labels = target.labels();
		const double all = double(target.size() + labels + 1);
		for (int a = 0; a < query.labelNumbers(); ++a)
		{
			const std::string& name = query.labelName(a);
			const int known = target.labelNumber(name);
			const double alike =
				known == GraphIndex::kNoLabel ? 0 : double(target.ofLabel(known).size());
			auto& ratios = ofLabel_.emplace_back();
			for (int b = 0; b < target.labelNumbers(); ++b)
				ratios.push_back(
					agreement.probability(name, target.labelName(b), labels) * all / (alike + 1));
		}
	}

	/** Of an object of the query, for each label of the map. */
	std::vector<double> ofLabels(std::size_t query) const
	{
		const auto& shares = query_.shares(query);
		if (shares.empty()) return ofLabel_[std::size_t(query_.labelOf(query))];
		std::vector<double> sum(ofLabel_[0].size(), 0.0);
		for (const auto& [label, share] : shares)
			for (std::size_t b = 0; b < sum.size(); ++b)
				sum[b] += double(share) * ofLabel_[std::size_t(label)][b];
		return sum;
	}
	/** Of an object of the map, given those of its labels. */
	static double of(
		std::size_t vertex, const GraphIndex& target, const std::vector<double>& ofLabels)
	{
		const auto& shares = target.shares(vertex);
		if (shares.empty()) return ofLabels[std::size_t(target.labelOf(vertex))];
		double sum = 0;
		for (const auto& [label, share] : shares)
			sum += double(share) * ofLabels[std::size_t(label)];
		return sum;
	}

private:
	const GraphIndex& query_;
	std::vector<std::vector<double>> ofLabel_;  //!< query's label, map's label
};
}  // namespace

MatchCandidates::MatchCandidates(
	const SemanticGraph& query, const GraphIndex& target, const LabelAgreement& agreement,
	const PlaceSearchOptions& options)
	: candidates_(query.vertices.size())
{
	const GraphIndex own(query);
	std::vector<int> labels;  // the map's numbers
	for (std::size_t j = 0; j < own.size(); ++j)
	{
		points_.push_back(own.point(j));
		labels.push_back(target.labelNumber(query.vertices[j].label));
	}
	measure();

	const Looks looks(own, target, labels, float(options.sameModelShare));
	const LabelRatios ratios(own, target, agreement);
	for (std::size_t j = 0; j < own.size(); ++j)
	{
		const bool isSeen = looks.areKnown() && own.hasEmbedding(j);
		const auto ratioOf = ratios.ofLabels(j);
		bool isMixed = false;
		for (int label = 0; label < target.labelNumbers(); ++label)
		{
			const bool sameLabel = label == labels[j];
			// Labels that speak against it, none in doubt, and nothing to look at.
			if (!sameLabel && !isSeen && !target.hasUncertainLabels() &&
				ratioOf[std::size_t(label)] <= 1)
				continue;
			const std::size_t before = candidates_[j].size();
			for (const auto& entry : target.ofLabel(label))
			{
				const double ratio = LabelRatios::of(entry.vertex, target, ratioOf);
				const bool looksAlike =
					isSeen && looks.similarity(j, entry.vertex) > looks.leastOfOtherLabel();
				if (!sameLabel && ratio <= 1 && !looksAlike) continue;
				auto weight = float(std::log(ratio));
				if (isSeen && target.hasEmbedding(entry.vertex))
					weight += looks.evidence(looks.similarity(j, entry.vertex), sameLabel);
				if (weight > kLeastWeight)
					candidates_[j].push_back(
						{entry.x, entry.y, entry.z, weight, entry.vertex,
						 float(own.centreVariance(j) + target.centreVariance(entry.vertex))});
			}
			isMixed = isMixed || (before > 0 && candidates_[j].size() > before);
		}
		if (isMixed)
			std::sort(
				candidates_[j].begin(), candidates_[j].end(),
				[](const Candidate& a, const Candidate& b)
				{ return std::tie(a.x, a.target) < std::tie(b.x, b.target); });
	}
}

void MatchCandidates::measure()
{
	if (points_.empty()) return;
	const auto count = double(points_.size());
	double low = points_[0].z, high = low;
	for (const auto& p : points_)
	{
		centroid_ += p;
		low = std::min(low, p.z);
		high = std::max(high, p.z);
	}
	centroid_ *= 1 / count;
	for (const auto& p : points_)
		spread_ += mrpt::square(p.x - centroid_.x) + mrpt::square(p.y - centroid_.y);
	spread_ = std::max(spread_ / count, kLeastSpread);
	volume_ = 2 * M_PI * spread_ * std::max(high - low, kLeastHeight);
}

double MatchCandidates::bestWeight(std::size_t query) const
{
	double best = -std::numeric_limits<double>::infinity();
	for (const auto& candidate : candidates_[query])
		best = std::max(best, double(candidate.weight));
	return best;
}

std::pair<const MatchCandidates::Candidate*, const MatchCandidates::Candidate*>
MatchCandidates::range(const std::vector<Candidate>& candidates, double low, double high)
{
	const auto* begin = candidates.data();
	const auto* end = begin + candidates.size();
	const auto isBefore = [&](const Candidate& c) { return double(c.x) < low; };
	const auto isWithin = [&](const Candidate& c) { return double(c.x) <= high; };
	if (candidates.size() > kFew)
	{
		begin = std::partition_point(begin, end, isBefore);
		return {begin, std::partition_point(begin, end, isWithin)};
	}
	while (begin != end && isBefore(*begin)) ++begin;
	while (begin != end && !isWithin(end[-1])) --end;
	return {begin, end};
}

}  // namespace semloop
