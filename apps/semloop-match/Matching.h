#pragma once

#include <semloop/loop_closure/PlaceRecognizer.h>

#include <iosfwd>
#include <optional>

namespace semloop
{
/** A verdict and how long it took. */
struct TimedVerdict
{
	LoopVerdict verdict;
	double milliseconds = 0;  //!< without reading files and indexing the target
};

TimedVerdict timedMatch(
	const PlaceRecognizer& recognizer, const SemanticGraph& query, const SemanticGraph& target,
	const GraphIndex& index, const std::optional<PosePrior>& prior);

void printForPerson(std::ostream& out, const TimedVerdict& result);
void printJson(std::ostream& out, const TimedVerdict& result);

}  // namespace semloop
