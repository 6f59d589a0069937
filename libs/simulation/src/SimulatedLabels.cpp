#include "SimulatedLabels.h"

#include <semloop/config/Error.h>

#include <algorithm>
#include <charconv>
#include <string>

namespace semloop
{
namespace
{
[[noreturn]] void reject(const std::string& entry, const std::string& why)
{
	throw UsageError(
		"confusions: \"" + entry + "\" " + why +
		"; use true>observed:probability, as chair>couch:0.2");
}

uint32_t labelOf(const std::string& name, const std::string& entry, const LabelSet& labels)
{
	const auto label = labels.find(name);
	if (!label) reject(entry, "names the label \"" + name + "\", which is not in the set");
	return uint32_t(*label);
}

struct Confusion
{
	uint32_t truth = 0;
	LabelScore observed;
};

Confusion parse(const std::string& entry, const LabelSet& labels)
{
	const auto arrow = entry.find('>');
	const auto colon = entry.rfind(':');
	if (arrow == std::string::npos || colon == std::string::npos || colon < arrow)
		reject(entry, "cannot be read");
	double p = -1;
	const char* const end = entry.data() + entry.size();
	const auto parsed = std::from_chars(entry.data() + colon + 1, end, p);
	if (parsed.ec != std::errc() || parsed.ptr != end || !(p >= 0 && p <= 1))
		reject(entry, "has no probability from 0 to 1");
	Confusion c;
	c.truth = labelOf(entry.substr(0, arrow), entry, labels);
	c.observed.label = labelOf(entry.substr(arrow + 1, colon - arrow - 1), entry, labels);
	c.observed.score = float(p);
	if (c.truth == c.observed.label) reject(entry, "confuses a label with itself");
	return c;
}

/** One of the scores' labels, as probable as its score; none with the rest up to `total`. */
std::optional<uint32_t> pick(const LabelScores& scores, double total, RandomStream& random)
{
	double u = total * random.uniform();
	for (const auto& s : scores)
		if ((u -= s.score) < 0) return s.label;
	return std::nullopt;
}

double sumOf(const LabelScores& scores)
{
	double sum = 0;
	for (const auto& s : scores) sum += s.score;
	return sum;
}
}  // namespace

SimulatedLabels::SimulatedLabels(const LabelSet& labels, const SimulatedDetectorOptions& options)
	: count_(uint32_t(labels.size())), rate_(options.confusionRate), confused_(labels.size())
{
	for (const auto& entry : options.confusions)
	{
		const Confusion c = parse(entry, labels);
		auto& row = confused_[c.truth];
		row.push_back(c.observed);
		if (sumOf(row) > 1 + 1e-6)
			reject(entry, "lets its label's probabilities sum to more than 1");
	}
}

uint32_t SimulatedLabels::otherThan(uint32_t label, RandomStream& random) const
{
	const uint32_t other = random.below(count_ - 1);
	return other < label ? other : other + 1;
}

uint32_t SimulatedLabels::leader(uint32_t truth, RandomStream& random) const
{
	const auto& row = confused_[truth];
	if (!row.empty()) return pick(row, 1.0, random).value_or(truth);
	return random.uniform() < rate_ ? otherThan(truth, random) : truth;
}

LabelScores SimulatedLabels::draw(uint32_t truth, double clarity, RandomStream& random) const
{
	const auto score = [&](double from, double to) { return random.uniform(from, to); };
	const double clear = std::clamp(0.7 + 0.25 * clarity + 0.03 * random.normal(), 0.55, 0.98);
	if (count_ < 2) return {{truth, float(clear)}};

	const uint32_t first = leader(truth, random);
	if (first != truth)
	{
		const double top = score(0.45, 0.65);
		const double second = std::min((1 - top) * score(0.5, 0.9), 0.95 * top);
		return {{first, float(top)}, {truth, float(second)}};
	}
	const auto& row = confused_[truth];
	const auto listed = pick(row, sumOf(row), random);
	const uint32_t second = listed ? *listed : otherThan(truth, random);
	return {{truth, float(clear)}, {second, float((1 - clear) * score(0.4, 0.8))}};
}

}  // namespace semloop
