#include <semloop/association/ConfusionMatrix.h>
#include <semloop/config/Error.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace semloop
{
namespace
{
using nlohmann::json;

constexpr const char* kFormat = "semloop.confusion/1";
constexpr double kRowSumTolerance = 1e-3;  // a file written by hand with three or four digits

/** Prints as short as the float allows: 0.9, not 0.8999999761581421. */
json shortNumber(float value)
{
	char text[32];
	const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
	double parsed = 0;
	std::from_chars(text, end, parsed);
	return parsed;
}

json parseFile(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be read; give a confusion matrix, " + kFormat);
	try
	{
		return json::parse(file);
	}
	catch (const json::parse_error& e)
	{
		throw InputError(
			path + ": byte " + std::to_string(e.byte) + ": not JSON; give a file that " +
			"semloop-learn-confusion wrote");
	}
}

LabelSet labelsFrom(const json& document, const std::string& path)
{
	const auto labels = document.find("labels");
	if (labels == document.end() || !labels->is_array())
		throw InputError(path + ": labels: missing or not a list; give the names of the classes");
	std::vector<std::string> names;
	for (const auto& label : *labels)
	{
		if (!label.is_string())
			throw InputError(
				path + ": labels[" + std::to_string(names.size()) + "] is not a text; give a name");
		names.push_back(label.get<std::string>());
	}
	try
	{
		return LabelSet(std::move(names));
	}
	catch (const InputError& e)
	{
		throw InputError(path + ": labels: " + e.what());
	}
}

void readRow(const json& row, const std::string& place, Eigen::Ref<Eigen::VectorXf> p)
{
	const auto n = p.size();
	if (!row.is_array() || Eigen::Index(row.size()) != n)
		throw InputError(
			place + ": not a list of " + std::to_string(n) + " numbers; give one a label");
	double sum = 0;
	for (Eigen::Index k = 0; k < n; ++k)
	{
		const double value = row[k].is_number() ? row[k].get<double>() : -1.0;
		if (!(value >= 0 && value <= 1))
			throw InputError(
				place + "[" + std::to_string(k) + "] = " + row[k].dump() +
				": not a probability; use 0 to 1");
		p[k] = float(value);
		sum += value;
	}
	if (std::abs(sum - 1) > kRowSumTolerance)
		throw InputError(place + ": sums to " + std::to_string(sum) + "; a row must sum to 1");
}
}  // namespace

ConfusionMatrix::ConfusionMatrix(LabelSet labels, Eigen::MatrixXf p)
	: labels_(std::move(labels)), p_(std::move(p))
{
}

ConfusionMatrix::ConfusionMatrix(LabelSet labels, double correct) : labels_(std::move(labels))
{
	if (!(correct >= 0 && correct <= 1))
		throw std::invalid_argument(
			"ConfusionMatrix: correct = " + std::to_string(correct) + "; use 0 to 1");
	const auto n = Eigen::Index(labels_.size());
	const double wrong = n > 1 ? (1 - correct) / double(n - 1) : 0;
	p_.setConstant(n, n, float(wrong));
	p_.diagonal().setConstant(n > 1 ? float(correct) : 1.0f);
}

ConfusionMatrix ConfusionMatrix::learn(
	LabelSet labels, const std::vector<std::pair<uint32_t, uint32_t>>& trueObserved,
	double smoothing)
{
	const auto n = Eigen::Index(labels.size());
	Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(n, n);
	for (std::size_t i = 0; i < trueObserved.size(); ++i)
	{
		const auto [truth, observed] = trueObserved[i];
		if (truth >= labels.size() || observed >= labels.size())
			throw InputError(
				"confusion matrix: pair " + std::to_string(i) + " is (" + std::to_string(truth) +
				", " + std::to_string(observed) + "); use labels below " +
				std::to_string(labels.size()));
		counts(truth, observed) += 1;
	}
	return learnFromCounts(std::move(labels), counts, smoothing);
}

ConfusionMatrix ConfusionMatrix::learnFromCounts(
	LabelSet labels, const Eigen::MatrixXd& counts, double smoothing)
{
	const auto n = Eigen::Index(labels.size());
	if (!(smoothing > 0 && std::isfinite(smoothing)))
		throw std::invalid_argument(
			"ConfusionMatrix: smoothing = " + std::to_string(smoothing) + "; use more than 0");
	if (counts.rows() != n || counts.cols() != n || !counts.allFinite() ||
		(counts.array() < 0).any())
		throw std::invalid_argument(
			"ConfusionMatrix: counts: not " + std::to_string(n) + " x " + std::to_string(n) +
			" numbers >= 0");
	Eigen::MatrixXd posterior = counts.array() + smoothing;
	posterior.diagonal().array() += 9 * smoothing;
	const Eigen::VectorXd totals = posterior.rowwise().sum();
	return {std::move(labels), (totals.cwiseInverse().asDiagonal() * posterior).cast<float>()};
}

ConfusionMatrix ConfusionMatrix::load(const std::string& path)
{
	const json document = parseFile(path);
	if (!document.is_object() || document.value("format", json()) != kFormat)
		throw InputError(path + ": format: not \"" + kFormat + "\"; give a confusion matrix");
	LabelSet labels = labelsFrom(document, path);
	const auto n = Eigen::Index(labels.size());
	const auto rows = document.find("p");
	if (rows == document.end() || !rows->is_array() || Eigen::Index(rows->size()) != n)
		throw InputError(
			path + ": p: not a list of " + std::to_string(n) + " rows; give one a label");
	Eigen::MatrixXf p(n, n);
	Eigen::VectorXf row(n);
	for (Eigen::Index truth = 0; truth < n; ++truth)
	{
		readRow((*rows)[truth], path + ": p[" + std::to_string(truth) + "]", row);
		p.row(truth) = row;
	}
	return {std::move(labels), std::move(p)};
}

void ConfusionMatrix::save(const std::string& path) const
{
	std::ofstream file(path);
	file << "{\"format\": \"" << kFormat << "\",\n\"labels\": " << json(labels_.names()).dump()
		 << ",\n\"p\": [";
	for (Eigen::Index truth = 0; truth < p_.rows(); ++truth)
	{
		json row = json::array();
		for (Eigen::Index observed = 0; observed < p_.cols(); ++observed)
			row.push_back(shortNumber(p_(truth, observed)));
		file << (truth == 0 ? "\n" : ",\n") << row.dump();
	}
	file << "\n]}\n";
	file.close();
	if (!file) throw InputError(path + ": cannot be written; choose another place");
}

void ConfusionMatrix::requireLabel(uint32_t label) const
{
	if (label >= labels_.size())
		throw InputError(
			"confusion matrix: label " + std::to_string(label) + " is not among its " +
			std::to_string(labels_.size()) + " labels; use the matrix of this network's labels");
}

double ConfusionMatrix::probability(uint32_t observed, uint32_t truth) const
{
	requireLabel(observed);
	requireLabel(truth);
	return p_(truth, observed);
}

double ConfusionMatrix::agreement(const LabelScores& observed, const LabelScores& truth) const
{
	for (const auto& k : observed) requireLabel(k.label);
	double sum = 0;
	for (const auto& j : truth)
	{
		requireLabel(j.label);
		for (const auto& k : observed) sum += double(k.score) * j.score * p_(j.label, k.label);
	}
	return std::clamp(sum, 0.0, 1.0);
}

}  // namespace semloop
