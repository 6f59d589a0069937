#include <semloop/config/Error.h>
#include <semloop/simulation/FurnitureCatalog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <sstream>

#include "Properties.h"
#include "ZipArchive.h"

namespace semloop
{
namespace
{
constexpr double kMetresPerCentimetre = 0.01;
constexpr const char* kPropertyFile = "PluginFurnitureCatalog.properties";

/** Without blanks at its ends, runs of them as one space. */
std::string tidy(const std::string& text)
{
	std::istringstream in(text);
	std::string result;
	for (std::string word; in >> word;) result += (result.empty() ? "" : " ") + word;
	return result;
}

/** The numbers of a text; none when there is something else in it. The same in every locale. */
std::vector<double> numbersIn(const std::string& text)
{
	std::istringstream in(text);
	std::vector<double> result;
	for (std::string word; in >> word;)
	{
		double value = 0;
		const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
		if (error != std::errc() || *end != '\0' || !std::isfinite(value)) return {};
		result.push_back(value);
	}
	return result;
}

/** The keys `name#number` of one model. */
class ModelProperties
{
public:
	ModelProperties(const std::map<std::string, std::string>& properties, std::string number)
		: properties_(properties), number_(std::move(number))
	{
	}

	std::string text(const std::string& name) const
	{
		const auto found = properties_.find(name + "#" + number_);
		return found == properties_.end() ? "" : tidy(found->second);
	}

	std::string requiredText(const std::string& name) const
	{
		const std::string value = text(name);
		if (value.empty()) throw InputError(name + "#" + number_ + " is missing");
		return value;
	}

	std::optional<double> metres(const std::string& name) const
	{
		const std::string value = text(name);
		if (value.empty()) return std::nullopt;
		const auto numbers = numbersIn(value);
		if (numbers.size() != 1)
			throw InputError(name + "#" + number_ + " is '" + value + "', not a number");
		return numbers[0] * kMetresPerCentimetre;
	}

	double requiredLength(const std::string& name) const
	{
		requiredText(name);
		const double length = metres(name).value();
		if (!(length > 0)) throw InputError(name + "#" + number_ + " is not above 0");
		return length;
	}

	Eigen::Matrix3d rotation() const
	{
		const std::string value = text("modelRotation");
		if (value.empty()) return Eigen::Matrix3d::Identity();
		const auto numbers = numbersIn(value);
		if (numbers.size() != 9)
			throw InputError("modelRotation#" + number_ + " is '" + value + "', not nine numbers");
		return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers.data());
	}

private:
	const std::map<std::string, std::string>& properties_;
	std::string number_;
};

CatalogEntry readEntry(const ModelProperties& model)
{
	CatalogEntry entry;
	entry.id = model.requiredText("id");
	entry.name = model.text("name");
	entry.category = model.text("category");
	entry.creator = model.text("creator");
	entry.model = model.requiredText("model");
	entry.size = {
		model.requiredLength("width"), model.requiredLength("depth"),
		model.requiredLength("height")};
	entry.elevation = model.metres("elevation").value_or(0);
	entry.top = std::max(model.metres("dropOnTopElevation").value_or(entry.size.z()), 0.0);
	entry.modelRotation = model.rotation();
	return entry;
}

std::vector<CatalogEntry> readArchive(const std::string& path)
{
	std::vector<CatalogEntry> entries;
	const ZipArchive archive(path);
	const std::string file = archive.read(kPropertyFile);
	try
	{
		const auto properties = parseProperties(file);
		const auto license = properties.find("license");
		const std::string prefix = "id#";
		for (auto id = properties.lower_bound(prefix);
			 id != properties.end() && id->first.compare(0, prefix.size(), prefix) == 0; ++id)
		{
			entries.push_back(readEntry({properties, id->first.substr(prefix.size())}));
			entries.back().archive = path;
			if (license != properties.end()) entries.back().license = tidy(license->second);
		}
	}
	catch (const InputError& e)
	{
		throw InputError(path + ": " + kPropertyFile + ": " + e.what());
	}
	return entries;
}

std::vector<std::string> archivesIn(const std::string& folder)
{
	std::vector<std::string> archives;
	std::error_code error;
	for (const auto& file : std::filesystem::directory_iterator(folder, error))
		if (file.path().extension() == ".sh3f") archives.push_back(file.path().string());
	if (error || archives.empty())
		throw InputError(
			folder +
			": no furniture catalogues (*.sh3f) here; install Debian's package "
			"sweethome3d-furniture");
	std::sort(archives.begin(), archives.end());
	return archives;
}

/** Levenshtein's distance: insertions, deletions and replacements of letters. */
std::size_t editDistance(const std::string& a, const std::string& b)
{
	std::vector<std::size_t> row(b.size() + 1);
	std::iota(row.begin(), row.end(), 0U);
	for (std::size_t i = 0; i < a.size(); i++)
	{
		std::size_t diagonal = row[0]++;
		for (std::size_t j = 0; j < b.size(); j++)
		{
			const std::size_t replaced = diagonal + (a[i] != b[j]);
			diagonal = row[j + 1];
			row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
		}
	}
	return row.back();
}

/** Only the part after '#' matters much: catalogues have long names. */
std::pair<std::size_t, std::size_t> distance(const std::string& a, const std::string& b)
{
	const auto shortName = [](const std::string& id) { return id.substr(id.rfind('#') + 1); };
	return {editDistance(shortName(a), shortName(b)), editDistance(a, b)};
}

}  // namespace

FurnitureCatalog FurnitureCatalog::open(const std::string& folder)
{
	FurnitureCatalog catalog;
	for (const std::string& archive : archivesIn(folder))
		for (CatalogEntry& entry : readArchive(archive))
		{
			const std::string id = entry.id;
			const auto [known, isNew] = catalog.entries_.emplace(id, std::move(entry));
			if (!isNew)
				throw InputError(
					archive + ": model '" + id + "' is in " + known->second.archive + " too");
		}
	return catalog;
}

const CatalogEntry& FurnitureCatalog::entry(const std::string& id) const
{
	if (const auto found = entries_.find(id); found != entries_.end()) return found->second;

	using Candidate = std::pair<std::pair<std::size_t, std::size_t>, std::string>;
	std::vector<Candidate> candidates;
	for (const auto& known : entries_)
		candidates.emplace_back(distance(id, known.first), known.first);
	std::sort(candidates.begin(), candidates.end());
	std::string message = "no model '" + id + "' in the furniture catalogues; similar ones:";
	for (std::size_t i = 0; i < std::min<std::size_t>(candidates.size(), 3); i++)
		message += (i == 0 ? " " : ", ") + candidates[i].second;
	throw InputError(message);
}

}  // namespace semloop
