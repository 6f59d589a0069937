#include "VertexLabels.h"

#include <semloop/config/Error.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

namespace semloop
{
namespace
{
[[noreturn]] void fail(const std::string& path, const std::string& problem)
{
	throw InputError(path + ": " + problem + "; give the annotated mesh of this sequence");
}

template <typename Number>
double valueOf(const char* bytes)
{
	static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "as the files");
	Number value{};
	std::memcpy(&value, bytes, sizeof(value));
	return double(value);
}

struct Type
{
	std::size_t size = 0;
	double (*read)(const char*) = nullptr;
};

template <typename Number>
constexpr Type typeFor()
{
	return {sizeof(Number), &valueOf<Number>};
}

Type typeOf(const std::string& name, const std::string& path)
{
	static const std::map<std::string, Type> types{
		{"char", typeFor<int8_t>()},     {"int8", typeFor<int8_t>()},
		{"uchar", typeFor<uint8_t>()},   {"uint8", typeFor<uint8_t>()},
		{"short", typeFor<int16_t>()},   {"int16", typeFor<int16_t>()},
		{"ushort", typeFor<uint16_t>()}, {"uint16", typeFor<uint16_t>()},
		{"int", typeFor<int32_t>()},     {"int32", typeFor<int32_t>()},
		{"uint", typeFor<uint32_t>()},   {"uint32", typeFor<uint32_t>()},
		{"float", typeFor<float>()},     {"float32", typeFor<float>()},
		{"double", typeFor<double>()},   {"float64", typeFor<double>()}};
	const auto found = types.find(name);
	if (found == types.end()) fail(path, "'" + name + "' is no type of a vertex's property");
	return found->second;
}

/** How a vertex is stored. */
struct Layout
{
	bool isText = false;
	std::size_t count = 0;              //!< vertices
	std::size_t columns = 0, size = 0;  //!< numbers and bytes of a vertex
	std::size_t labelColumn = 0, labelOffset = 0;
	Type label;
};

/** Reads the header. */
Layout readLayout(std::istream& in, const std::string& path)
{
	Layout layout;
	int elements = 0;
	std::string line, keyword, name;
	if (!std::getline(in, line) || line.rfind("ply", 0) != 0) fail(path, "not a PLY file");
	while (keyword != "end_header" && std::getline(in, line))
	{
		std::istringstream words(line);
		words >> keyword >> name;
		if (keyword == "format") layout.isText = name == "ascii";
		if (keyword == "element" && ++elements == 1)
		{
			if (name != "vertex") fail(path, "its first element is not the vertices");
			words >> layout.count;
		}
		if (keyword != "property" || elements != 1) continue;
		const Type type = typeOf(name, path);
		words >> name;
		if (name == "label")
		{
			layout.label = type;
			layout.labelColumn = layout.columns;
			layout.labelOffset = layout.size;
		}
		layout.columns++;
		layout.size += type.size;
	}
	if (!layout.label.read) fail(path, "its vertices have no property 'label'");
	return layout;
}

double readLabel(std::istream& in, const Layout& layout, std::vector<char>& bytes)
{
	if (!layout.isText)
	{
		in.read(bytes.data(), std::streamsize(bytes.size()));
		return layout.label.read(bytes.data() + layout.labelOffset);
	}
	double value = 0, label = 0;
	for (std::size_t column = 0; column < layout.columns; column++)
	{
		in >> value;
		if (column == layout.labelColumn) label = value;
	}
	return label;
}

}  // namespace

std::vector<uint32_t> readVertexLabels(const std::string& path)
{
	std::ifstream in(path, std::ios::binary);
	if (!in) throw InputError(path + ": cannot be read; does it exist?");
	const Layout layout = readLayout(in, path);
	std::vector<char> bytes(layout.size);
	std::vector<uint32_t> labels;
	for (std::size_t i = 0; i < layout.count; i++)
	{
		const double label = readLabel(in, layout, bytes);
		if (!in) fail(path, "it ends early, or holds what is no number");
		if (!(label >= 0 && label <= std::numeric_limits<uint32_t>::max()) ||
			label != std::floor(label))
			fail(path, "vertex " + std::to_string(i) + " has a label that is no id");
		labels.push_back(uint32_t(label));
	}
	return labels;
}

}  // namespace semloop
