#pragma once

#include <semloop/loop_closure/PlaceRecognizer.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace semloop
{
/** What a scenario of matching problems shows. Shares are in percent and empty when nothing was counted. */
struct ScenarioResult
{
	std::string name;
	std::size_t positives = 0, negatives = 0;
	std::size_t rightPoses = 0;       //!< among positives, accepted or not
	std::size_t accepted = 0;         //!< loops
	std::size_t acceptedRight = 0;    //!< on positives, with a right pose
	std::size_t acceptedForeign = 0;  //!< on negatives
	std::size_t ambiguous = 0;
	std::size_t matches = 0, trueMatches = 0, rightMatches = 0;  //!< of positives
	std::vector<double> milliseconds;
};

/** Runs the problems of a folder with a truth.json, or of each folder in it that has one, by name. Throws
 *  InputError naming file and place when there is none or one is damaged. */
std::vector<ScenarioResult> runBatch(
	const std::string& folder, const PlaceRecognizer& recognizer, bool usePrior);

void printTable(std::ostream& out, const std::vector<ScenarioResult>& results);
void printJson(std::ostream& out, const std::vector<ScenarioResult>& results);

}  // namespace semloop
