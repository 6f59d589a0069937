#include <semloop/config/Error.h>
#include <semloop/object_map/AssociationRecord.h>
#include <semloop/observations/UnixTime.h>

#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>

namespace semloop
{
namespace
{
constexpr const char* kHeading = "time,frame,instance,x,y,w,h,object,first_object";

std::vector<std::string> splitAtCommas(const std::string& line)
{
	std::vector<std::string> cells;
	std::istringstream in(line);
	for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
	return cells;
}

/** False unless the whole text is such a number. */
template <class Number>
bool parse(const std::string& text, Number& number)
{
	const auto end = text.data() + text.size();
	const auto result = std::from_chars(text.data(), end, number);
	return result.ec == std::errc() && result.ptr == end;
}

std::optional<AssociationRecord> parseRecord(const std::string& line)
{
	const auto cells = splitAtCommas(line);
	if (cells.size() != 9) return std::nullopt;
	AssociationRecord a;
	const auto time = parseUnixTime(cells[0]);
	const bool good = time && parse(cells[1], a.frame) && parse(cells[2], a.instance) &&
					  parse(cells[3], a.box.x) && parse(cells[4], a.box.y) &&
					  parse(cells[5], a.box.width) && parse(cells[6], a.box.height) &&
					  parse(cells[7], a.object) && parse(cells[8], a.firstObject);
	if (!good) return std::nullopt;
	a.time = *time;
	return a;
}
}  // namespace

std::string associationsAsCsv(const std::vector<AssociationRecord>& associations)
{
	std::ostringstream out;
	out << kHeading << "\n";
	for (const AssociationRecord& a : associations)
		out << formatUnixTime(a.time) << "," << a.frame << "," << a.instance << "," << a.box.x
			<< "," << a.box.y << "," << a.box.width << "," << a.box.height << "," << a.object << ","
			<< a.firstObject << "\n";
	return out.str();
}

std::vector<AssociationRecord> readAssociations(const std::string& path)
{
	std::ifstream file(path);
	if (!file) throw InputError(path + ": cannot be read; give what semloop-slam wrote");
	std::vector<AssociationRecord> result;
	std::string line;
	if (!std::getline(file, line) || line != kHeading)
		throw InputError(path + ":1: the heading is not " + kHeading + "; run semloop-slam again");
	for (std::size_t number = 2; std::getline(file, line); number++)
	{
		const auto record = parseRecord(line);
		if (!record)
			throw InputError(
				path + ":" + std::to_string(number) + ": '" + line +
				"' is no time with eight integers; run semloop-slam again");
		result.push_back(*record);
	}
	return result;
}

}  // namespace semloop
