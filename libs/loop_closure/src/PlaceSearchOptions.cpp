#include <semloop/config/Error.h>
#include <semloop/loop_closure/PlaceSearch.h>

namespace semloop
{
void PlaceSearchOptions::describe(OptionFields& fields)
{
	fields.number(
		"reobserved_share", reobservedShare, 0.01, 0.99,
		"share of the query's objects that the map has too, when the place is known");
	fields.number(
		"label_accuracy", labelAccuracy, 0.01, 0.999,
		"probability that two observations of one object have one label");
	fields.number(
		"same_model_share", sameModelShare, 0.0001, 0.5,
		"share of different objects that look the same");
	fields.number(
		"min_sigma", minSigma, 0.001, 10, "least error of a centre that is considered [m]");
	fields.number("max_sigma", maxSigma, 0.001, 10, "largest error of a centre, same [m]");
	fields.number(
		"bad_centre_share", badCentreShare, 0.0001, 0.9,
		"share of objects whose centre's error is three times that");
	fields.number(
		"rival_distance", rivalDistance, 0.01, 100,
		"a pose that moves the query's objects at least this far from ours is a rival [m]");
	fields.number(
		"prior_doubt", priorDoubt, 0, 1,
		"probability that odometry's prior is wrong, and the query may be anywhere");
	fields.number(
		"odds_per_evidence", oddsPerEvidence, 0, 10,
		"calibration: log odds for a unit of evidence above that of all rivals");
	fields.number(
		"odds_per_share", oddsPerShare, 0, 1000,
		"calibration: log odds for the matched share of the query");
	fields.number(
		"even_odds", evenOdds, -1000, 1000, "calibration: sum of both at a probability of 0.5");
}

void PlaceSearchOptions::requireConsistent() const
{
	if (minSigma > maxSigma) throw UsageError("min_sigma: must not be larger than max_sigma");
}

}  // namespace semloop
