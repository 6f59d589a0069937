#include "LabelPairs.h"

#include <semloop/config/Error.h>

#include <charconv>
#include <fstream>
#include <sstream>
#include <vector>

namespace semloop
{
namespace
{
constexpr int kMaxCount = 1'000'000'000;

std::string trimmed(const std::string& text)
{
	const auto begin = text.find_first_not_of(" \t\r");
	if (begin == std::string::npos) return {};
	return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string> fieldsOf(const std::string& line)
{
	std::vector<std::string> fields;
	std::istringstream stream(line);
	for (std::string field; std::getline(stream, field, ',');) fields.push_back(trimmed(field));
	if (line.back() == ',') fields.emplace_back();
	return fields;
}

std::size_t labelOf(const std::string& name, const LabelSet& labels, const std::string& place)
{
	const auto label = labels.find(name);
	if (!label)
		throw InputError(
			place + ": '" + name + "' is not one of the " + std::to_string(labels.size()) +
			" labels; correct it or give the network's own names with --labels");
	return *label;
}

int countOf(const std::string& text, const std::string& place)
{
	int count = 0;
	const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
	if (error != std::errc{} || end != text.data() + text.size() || count < 0 || count > kMaxCount)
		throw InputError(
			place + ": count '" + text + "' is not allowed; use a whole number from 0 to " +
			std::to_string(kMaxCount));
	return count;
}
}  // namespace

Eigen::MatrixXd countLabelPairs(const std::string& path, const LabelSet& labels)
{
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be read; give a CSV file of true,observed labels");
	const auto n = Eigen::Index(labels.size());
	Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(n, n);
	std::string raw;
	for (int number = 1; std::getline(file, raw); ++number)
	{
		const std::string line = trimmed(raw);
		if (line.empty() || line.front() == '#') continue;
		const std::string place = path + ":" + std::to_string(number);
		const auto fields = fieldsOf(line);
		if (fields.size() < 2 || fields.size() > 3)
			throw InputError(
				place + ": " + std::to_string(fields.size()) +
				" columns; write true,observed or true,observed,count");
		const auto truth = labelOf(fields[0], labels, place);
		const auto observed = labelOf(fields[1], labels, place);
		counts(truth, observed) += fields.size() == 3 ? countOf(fields[2], place) : 1;
	}
	if (file.bad()) throw InputError(path + ": reading stopped half-way; give a CSV file");
	if (counts.sum() == 0)
		throw InputError(path + ": no pair of labels in it; add true,observed lines");
	return counts;
}

}  // namespace semloop
