#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileBase.h>
#include <semloop/config/Error.h>
#include <semloop/config/Options.h>
#include <semloop/config/ReadText.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <ostream>
#include <sstream>

namespace semloop
{
namespace
{
constexpr double kDegreesPerRadian = 180.0 / 3.14159265358979323846;

std::string join(const std::vector<std::string>& items, const std::string& separator)
{
	std::string all;
	for (const auto& item : items) all += (all.empty() ? "" : separator) + item;
	return all;
}

std::string trimmed(const std::string& text)
{
	const auto begin = text.find_first_not_of(" \t\r");
	if (begin == std::string::npos) return {};
	return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/** MRPT strips comments that begin with // or #; an ini file may also have "; ..." behind a value. */
std::string withoutComment(const std::string& text)
{
	const auto comment = text.find(" ;");
	return trimmed(text.substr(0, std::min(comment, text.find("\t;"))));
}

std::string toString(double value)
{
	std::ostringstream out;
	out.precision(10);
	out << value;
	return out.str();
}

std::string allowed(const OptionField& field)
{
	if (std::holds_alternative<bool*>(field.target)) return "true, false";
	if (!field.choices.empty()) return join(field.choices, ", ");
	if (std::holds_alternative<std::string*>(field.target)) return "text";
	if (std::holds_alternative<std::vector<std::string>*>(field.target)) return "list, a, b, ...";
	const std::string kind = std::holds_alternative<int*>(field.target) ? "integer" : "number";
	if (std::isinf(field.maximum)) return kind + " >= " + toString(field.minimum);
	return kind + " in [" + toString(field.minimum) + ", " + toString(field.maximum) + "]";
}

/** The value as the file has it. */
std::string valueText(const OptionField& field)
{
	if (auto flag = std::get_if<bool*>(&field.target)) return **flag ? "true" : "false";
	if (auto integer = std::get_if<int*>(&field.target)) return std::to_string(**integer);
	if (auto number = std::get_if<double*>(&field.target)) return toString(**number * field.scale);
	if (auto text = std::get_if<std::string*>(&field.target)) return **text;
	return join(*std::get<std::vector<std::string>*>(field.target), ", ");
}

template <class Number>
bool parseNumber(const std::string& text, Number& value)
{
	const char* end = text.data() + text.size();
	const auto result = std::from_chars(text.data(), end, value);
	return result.ec == std::errc{} && result.ptr == end;
}

/** False when the text is not one of the field's values. */
bool assign(const OptionField& field, const std::string& text)
{
	if (auto flag = std::get_if<bool*>(&field.target))
	{
		const bool yes = text == "true" || text == "1" || text == "yes";
		if (!yes && text != "false" && text != "0" && text != "no") return false;
		**flag = yes;
		return true;
	}
	if (auto integer = std::get_if<int*>(&field.target))
	{
		int value = 0;
		if (!parseNumber(text, value) || value < field.minimum || value > field.maximum)
			return false;
		**integer = value;
		return true;
	}
	if (auto number = std::get_if<double*>(&field.target))
	{
		double value = 0;
		if (!parseNumber(text, value) || !std::isfinite(value)) return false;
		if (value < field.minimum || value > field.maximum) return false;
		**number = value / field.scale;
		return true;
	}
	if (auto string = std::get_if<std::string*>(&field.target))
	{
		const auto& choices = field.choices;
		if (!choices.empty() && std::find(choices.begin(), choices.end(), text) == choices.end())
			return false;
		**string = text;
		return true;
	}
	auto& items = *std::get<std::vector<std::string>*>(field.target);
	items.clear();
	std::istringstream stream(text);
	for (std::string item; std::getline(stream, item, ',');)
		if (!trimmed(item).empty()) items.push_back(trimmed(item));
	return true;
}
}  // namespace

void OptionFields::flag(std::string key, bool& value, std::string help)
{
	fields_.push_back({std::move(key), &value, 0, 1, 1, {}, std::move(help)});
}

void OptionFields::integer(std::string key, int& value, int minimum, int maximum, std::string help)
{
	fields_.push_back(
		{std::move(key), &value, double(minimum), double(maximum), 1, {}, std::move(help)});
}

void OptionFields::number(
	std::string key, double& value, double minimum, double maximum, std::string help)
{
	fields_.push_back({std::move(key), &value, minimum, maximum, 1, {}, std::move(help)});
}

void OptionFields::degrees(
	std::string key, double& value, double minimumDeg, double maximumDeg, std::string help)
{
	fields_.push_back(
		{std::move(key), &value, minimumDeg, maximumDeg, kDegreesPerRadian, {}, std::move(help)});
}

void OptionFields::text(std::string key, std::string& value, std::string help)
{
	fields_.push_back({std::move(key), &value, 0, 0, 1, {}, std::move(help)});
}

void OptionFields::choice(
	std::string key, std::string& value, std::vector<std::string> choices, std::string help)
{
	fields_.push_back({std::move(key), &value, 0, 0, 1, std::move(choices), std::move(help)});
}

void OptionFields::list(std::string key, std::vector<std::string>& value, std::string help)
{
	fields_.push_back({std::move(key), &value, 0, 0, 1, {}, std::move(help)});
}

std::vector<OptionField> Options::fields() const
{
	OptionFields result;
	// The fields point into *this; describe() itself changes nothing.
	const_cast<Options*>(this)->describe(result);
	return result.all();
}

void Options::loadFromConfigFile(
	const mrpt::config::CConfigFileBase& source, const std::string& section)
{
	OptionFields description;
	describe(description);

	std::vector<std::string> keys;
	source.getAllKeys(section, keys);
	for (const auto& key : keys)
	{
		const auto& all = description.all();
		const auto field =
			std::find_if(all.begin(), all.end(), [&](const auto& f) { return f.key == key; });
		const std::string place = configFileName(source) + ": [" + section + "] " + key;
		if (field == all.end())
		{
			std::vector<std::string> known;
			for (const auto& f : all) known.push_back(f.key);
			throw UsageError(
				place + ": unknown key; this section has " +
				(known.empty() ? std::string("no keys") : join(known, ", ")));
		}
		const std::string text = readText(source, section, key);
		if (!assign(*field, text))
			throw UsageError(place + " = " + text + ": not allowed; use " + allowed(*field));
	}
	try
	{
		requireConsistent();
	}
	catch (const UsageError& error)
	{
		throw UsageError(configFileName(source) + ": [" + section + "] " + error.what());
	}
}

void Options::saveToConfigFile(
	mrpt::config::CConfigFileBase& target, const std::string& section) const
{
	for (const auto& field : fields())
		target.write(section, field.key, valueText(field), -1, -1, field.help);
}

void Options::dumpToTextStream(std::ostream& out) const
{
	for (const auto& field : fields()) out << field.key << " = " << valueText(field) << "\n";
}

std::string Options::markdownTable() const
{
	std::string table = "| key | default | allowed | meaning |\n| --- | --- | --- | --- |\n";
	for (const auto& field : fields())
	{
		const std::string value = valueText(field);
		table += "| `" + field.key + "` | " + (value.empty() ? "" : "`" + value + "`") + " | " +
				 allowed(field) + " | " + field.help + " |\n";
	}
	return table;
}

std::string readText(
	const mrpt::config::CConfigFileBase& source, const std::string& section, const std::string& key)
{
	return withoutComment(source.read_string(section, key, ""));
}

std::string configFileName(const mrpt::config::CConfigFileBase& source)
{
	const auto* file = dynamic_cast<const mrpt::config::CConfigFile*>(&source);
	return file ? file->getAssociatedFile() : "configuration";
}

void requireKnownSections(
	const mrpt::config::CConfigFileBase& source, const std::vector<std::string>& known)
{
	// MRPT has a nameless section for what stands above the first one.
	std::vector<std::string> homeless;
	source.getAllKeys("", homeless);
	if (!homeless.empty())
		throw UsageError(
			configFileName(source) + ": " + homeless.front() +
			": stands above the first section; put it below one of [" + join(known, "], [") + "]");
	std::vector<std::string> sections;
	source.getAllSections(sections);
	for (const auto& section : sections)
		if (!section.empty() && std::find(known.begin(), known.end(), section) == known.end())
			throw UsageError(
				configFileName(source) + ": [" + section + "]: unknown section; use " +
				join(known, ", "));
}

}  // namespace semloop
