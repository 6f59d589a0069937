#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/loop_closure/GraphIndex.h>
#include <semloop/loop_closure/GraphMatcher.h>
#include <semloop/loop_closure/LabelAgreement.h>
#include <semloop/loop_closure/PosePrior.h>

#include <memory>
#include <optional>
#include <vector>

namespace semloop
{
struct PlaceSearchOptions : Options
{
	double reobservedShare = 0.6;   //!< P_m, of the query's objects that the map has too
	double labelAccuracy = 0.92;    //!< two observations of one object have one label
	double sameModelShare = 0.025;  //!< of different objects that look the same
	double minSigma = 0.03;        //!< of the difference of two centres of one object, per axis [m]
	double maxSigma = 0.3;         //!< same [m]
	double badCentreShare = 0.15;  //!< of re-observed objects whose sigma is three times that
	double rivalDistance = 0.8;  //!< poses that move the query's centres this far apart differ [m]
	double priorDoubt = 1e-6;    //!< probability that the prior is wrong
	double oddsPerEvidence = 0.42;  //!< see probabilityOf()
	double oddsPerShare = 14.2;     //!< same
	double evenOdds = 15.3;         //!< same

	/** Public: the loop detector has these keys in its own section. */
	void describe(OptionFields& fields) override;
	void requireConsistent() const override;
};

/** Where the query may belong. */
struct Place
{
	mrpt::poses::CPose3D T_target_query;  //!< x, y, z, yaw
	std::vector<Match> matches;           //!< by query index
	double evidence = 0;  //!< ln of p(query | this place) / p(query | nowhere in the map)
	double sigma = 0;     //!< of the matched centres' differences, per axis [m]
	double yawSigma =
		0;  //!< of the pose's yaw: sigma / (R sqrt(n)), with a prior both together [rad]
	double priorSigmas = 0;  //!< Mahalanobis distance from the prior; 0 without one
};

struct Places
{
	std::vector<Place>
		found;  //!< best first, no two nearer than rivalDistance; at least two matches each
	/** The search came to its end: no pose that most of the query's objects agree on is missing. */
	bool complete = true;
};

/** Finds the places of a map where a local map, the query, may belong, by maximum evidence.
 *
 *  Both worlds have z up, so a pose T has x, y, z and yaw. Given T, object j of the query is either
 *  object k of the map, seen again (probability P_m), or something else, which may be anywhere in the
 *  query's own volume V and have any label. The evidence of a match is the logarithm of the ratio,
 *      e_jk(T) = ln P_m / (1 - P_m) + ln V K_sigma(T q_j - t_k) + ln p(l_j | l_k) / p(l_j)
 *                + ln p(s_jk | same) / p(s_jk | different),
 *  K_sigma = (1 - b) N(0, sigma^2 I) + b N(0, 9 sigma^2 I) for centres of objects that were seen in
 *  part, and where it is known how much of both was seen, sigma^2 + centreSigma(j)^2 + centreSigma(k)^2 for sigma^2; l labels, p(l_j | l_k) by LabelAgreement, p(l) their share in the map, both averaged over the label
 *  scores of objects that have some; s the similarity of the embeddings, its distribution
 *  among different objects fitted to all pairs, that of the same object to the best of each query object.
 *  sigma is not known: the best of a range is taken. The evidence of a place is
 *      E(T) = sum of e_jk over the best one-to-one matches + ln p(T) + ln (2 pi)^2 sigma^4 / (n^2 R),
 *  the last term Laplace's approximation of the integral over T round its best value, with n matches
 *  whose horizontal spread is R (D. MacKay, Information Theory, Inference, and Learning Algorithms, 2003,
 *  ch. 28: the Occam factor). p(T) is uniform over the map or, with a prior, its Gaussian and with
 *  probability prior_doubt uniform: a prior weighs places, it hides none. The yaw of a place near the prior
 *  is the mean of both, by their variances.
 *
 *  Two matches make a pose: those whose horizontal and vertical distances agree are tried, all of them up
 *  to 16 objects in the query, and chosen ones beyond and in maps of thousands: any place that explains half of the
 *  objects is met by several pairs. Nothing is left to chance; where thousands of objects look alike the search ends
 *  before it is complete, and says so. Objects of another label are candidates when they look the same or their label scores speak for it. */
class PlaceSearch
{
public:
	/** Labels agree as label_accuracy says. */
	PlaceSearch(
		const SemanticGraph& query, const GraphIndex& target,
		const PlaceSearchOptions& options = {});
	PlaceSearch(
		const SemanticGraph& query, const GraphIndex& target, const LabelAgreement& agreement,
		const PlaceSearchOptions& options);
	~PlaceSearch();
	PlaceSearch(const PlaceSearch&) = delete;
	PlaceSearch& operator=(const PlaceSearch&) = delete;

	Places places(const std::optional<PosePrior>& prior = {}) const;

	/** Those that two of these matches propose; all objects of the query have a say. */
	Places placesOf(
		const std::vector<Match>& matches, const std::optional<PosePrior>& prior = {}) const;

	/** The place under another prior: its evidence and its distance from the prior change, its pose does not. */
	Place reweighed(Place place, const PosePrior& before, const PosePrior& now) const;

	/** Root mean square distance between where two poses put the query's centres [m]. */
	double distance(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b) const;

	class Impl;

private:
	std::unique_ptr<Impl> impl_;
};

/** Probability that the query, of `objects` objects, belongs to this place, and not to one of the rivals
 *  nor outside of the map:
 *      logistic(a (E - ln(1 + sum of e^E over the rivals)) + b matches / objects - c),
 *  with a, b, c = odds_per_evidence, odds_per_share, even_odds. The model takes errors for independent and
 *  its noise for the best that fits, so that the evidence alone is too sure of itself; the three numbers
 *  are the logistic regression of doc/loop-detection.md. */
double probabilityOf(
	const Place& place, std::size_t objects, const std::vector<Place>& rivals,
	const PlaceSearchOptions& options);

}  // namespace semloop
