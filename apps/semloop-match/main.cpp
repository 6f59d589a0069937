#include <semloop/config/Error.h>

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "Application.h"
#include "Batch.h"
#include "GraphInput.h"
#include "Matching.h"

namespace
{
using namespace semloop;

/** All of a text must be `count` numbers, with blanks or commas between. */
std::vector<double> numbersFrom(std::string text, std::size_t count, const std::string& option)
{
	for (char& c : text)
		if (c == ',') c = ' ';
	std::istringstream words(text);
	std::vector<double> numbers;
	for (double number = 0; words >> number;) numbers.push_back(number);
	if (numbers.size() != count || !words.eof())
		throw UsageError(
			option + " '" + text + "': give " + std::to_string(count) +
			" numbers with blanks between, in quotes");
	return numbers;
}

std::optional<PosePrior> priorFrom(
	TCLAP::ValueArg<std::string>& pose, TCLAP::ValueArg<std::string>& sigma)
{
	if (!pose.isSet())
	{
		if (sigma.isSet()) throw UsageError("--prior-sigma is only for --prior; give both");
		return {};
	}
	PosePrior prior;
	try
	{
		prior.T_target_query =
			poseFromMatrix(numbersFrom(pose.getValue(), 16, "--prior"), "--prior");
	}
	catch (const InputError& error)
	{
		throw UsageError(error.what());
	}
	if (sigma.isSet())
	{
		const auto numbers = numbersFrom(sigma.getValue(), 3, "--prior-sigma");
		for (const double number : numbers)
			if (!(number > 0 && number < 1e6))
				throw UsageError("--prior-sigma: give numbers above 0, in metres and radians");
		prior.sigmaXY = numbers[0];
		prior.sigmaZ = numbers[1];
		prior.sigmaYaw = numbers[2];
	}
	return prior;
}

int run(int argc, char** argv)
{
	using Text = TCLAP::ValueArg<std::string>;
	TCLAP::CmdLine line(
		"Finds one semantic graph in another: says whether the query is a place of the target, "
		"which, and how sure that is.",
		' ', SEMLOOP_VERSION);
	TCLAP::SwitchArg usePrior(
		"", "use-prior", "With --batch: hand in the priors of truth.json.", line);
	Text batch(
		"", "batch", "Run all problems of a folder with a truth.json, or of the folders in it.",
		false, "", "DIR", line);
	TCLAP::SwitchArg asJson("", "json", "Print one JSON object.", line);
	std::string names;
	for (const auto& name : PlaceRecognizer::matcherNames())
		names += (names.empty() ? "" : ", ") + name;
	Text matcher(
		"", "matcher", "One of " + names + ", or the class name of another graph matcher.", false,
		"pairwise", "NAME", line);
	Text sigma(
		"", "prior-sigma",
		"Standard deviations of the prior [m, m, rad]; 0.8 0.1 0.1 unless given.", false, "",
		"XY Z YAW", line);
	Text prior(
		"", "prior", "What odometry claims for T_target_query: 16 numbers, row by row.", false, "",
		"NUMBERS", line);
	Text confusion(
		"", "confusion",
		"How labels are mistaken for each other, as semloop-learn-confusion writes it.", false, "",
		"FILE", line);
	TCLAP::UnlabeledMultiArg<std::string> graphs(
		"graphs", "QUERY and TARGET: semantic graphs (.json) or object maps (.objmap).", false,
		"QUERY TARGET", line);
	if (!parseArguments(line, argc, argv)) return kSuccess;

	PlaceRecognizerOptions options;
	options.matcher = matcher.getValue();
	PlaceRecognizer recognizer(options, "--matcher");
	if (confusion.isSet())
		recognizer.setConfusionMatrix(ConfusionMatrix::load(confusion.getValue()));
	if (batch.isSet())
	{
		if (!graphs.getValue().empty() || prior.isSet())
			throw UsageError(
				"--batch takes graphs and priors from truth.json; give the folder alone");
		const auto results = runBatch(batch.getValue(), recognizer, usePrior.getValue());
		asJson.getValue() ? printJson(std::cout, results) : printTable(std::cout, results);
		return kSuccess;
	}
	if (usePrior.getValue()) throw UsageError("--use-prior is only for --batch; give --prior");
	if (graphs.getValue().size() != 2)
		throw UsageError("give two graphs, QUERY and TARGET; see --help");
	const auto claimed = priorFrom(prior, sigma);
	const auto query = readGraph(graphs.getValue()[0]), target = readGraph(graphs.getValue()[1]);
	const auto result = timedMatch(recognizer, query, target, GraphIndex(target), claimed);
	asJson.getValue() ? printJson(std::cout, result) : printForPerson(std::cout, result);
	return kSuccess;
}
}  // namespace

int main(int argc, char** argv)
{
	return semloop::runApplication("semloop-match", [&] { return run(argc, argv); });
}
