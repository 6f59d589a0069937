#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <iosfwd>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace semloop
{
/** One option of a module: where its value lives, what is allowed, and one line for the manual. */
struct OptionField
{
	using Target = std::variant<bool*, int*, double*, std::string*, std::vector<std::string>*>;

	std::string key;
	Target target;
	double minimum = -std::numeric_limits<double>::infinity();
	double maximum = std::numeric_limits<double>::infinity();
	double scale = 1.0;  //!< value in the file = value in memory * scale (180 / pi for degrees)
	std::vector<std::string> choices;  //!< of a string; empty: any
	std::string help;                  //!< one line: meaning, unit, equation
};

/** Collects the fields of an options struct; see Options::describe(). */
class OptionFields
{
public:
	void flag(std::string key, bool& value, std::string help);
	void integer(std::string key, int& value, int minimum, int maximum, std::string help);
	void number(std::string key, double& value, double minimum, double maximum, std::string help);
	/** An angle: radians in memory, degrees in the file; the key must end in "_deg". */
	void degrees(
		std::string key, double& value, double minimumDeg, double maximumDeg, std::string help);
	void text(std::string key, std::string& value, std::string help);
	void choice(
		std::string key, std::string& value, std::vector<std::string> choices, std::string help);
	/** A comma-separated list. */
	void list(std::string key, std::vector<std::string>& value, std::string help);

	const std::vector<OptionField>& all() const { return fields_; }

private:
	std::vector<OptionField> fields_;
};

/** Base of every module's XxxOptions: the struct names its fields once, in describe(); loading,
 *  saving, dumping and the manual's configuration reference all follow from that.
 *
 *  Loading is strict: an unknown key, a value of the wrong type or out of range throws UsageError
 *  with file, section, key, value and what is allowed; so do values that do not fit together. A missing key or section keeps the default. */
class Options : public mrpt::config::CLoadableOptions
{
public:
	void loadFromConfigFile(
		const mrpt::config::CConfigFileBase& source, const std::string& section) override;
	void saveToConfigFile(
		mrpt::config::CConfigFileBase& target, const std::string& section) const override;
	void dumpToTextStream(std::ostream& out) const override;

	/** A Markdown table (key, default, allowed, meaning) of the current values. */
	std::string markdownTable() const;

	std::vector<OptionField> fields() const;

	/** Throws UsageError when the values do not fit together; loading calls it. */
	virtual void requireConsistent() const {}

protected:
	virtual void describe(OptionFields& fields) = 0;
};

/** The name of the file behind a configuration, for error messages; "configuration" when it lives
 *  in memory. */
std::string configFileName(const mrpt::config::CConfigFileBase& source);

/** Throws UsageError when the file has a section that is not among the known ones, or a key outside
 *  any section. */
void requireKnownSections(
	const mrpt::config::CConfigFileBase& source, const std::vector<std::string>& known);

}  // namespace semloop
