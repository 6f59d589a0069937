#include <semloop/config/Error.h>
#include <semloop/evaluation/PlyFile.h>

#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace semloop
{
namespace
{
enum class Type
{
	Int8,
	Uint8,
	Int16,
	Uint16,
	Int32,
	Uint32,
	Float,
	Double
};

struct Property
{
	std::string name;
	Type type = Type::Float;
	std::optional<Type> countType;  //!< of a list
};

struct Element
{
	std::string name;
	std::size_t count = 0;
	std::vector<Property> properties;
};

[[noreturn]] void fail(const std::string& path, const std::string& problem)
{
	throw InputError(path + ": " + problem + "; write it again");
}

Type typeOf(const std::string& name, const std::string& path)
{
	static const std::map<std::string, Type> types{
		{"char", Type::Int8},     {"int8", Type::Int8},     {"uchar", Type::Uint8},
		{"uint8", Type::Uint8},   {"short", Type::Int16},   {"int16", Type::Int16},
		{"ushort", Type::Uint16}, {"uint16", Type::Uint16}, {"int", Type::Int32},
		{"int32", Type::Int32},   {"uint", Type::Uint32},   {"uint32", Type::Uint32},
		{"float", Type::Float},   {"float32", Type::Float}, {"double", Type::Double},
		{"float64", Type::Double}};
	const auto found = types.find(name);
	if (found == types.end()) fail(path, "'" + name + "' is no type of a PLY file");
	return found->second;
}

/** The numbers behind the header, one after the other. */
class Numbers
{
public:
	Numbers(std::istream& in, bool isText, const std::string& path)
		: in_(in), isText_(isText), path_(path)
	{
	}

	double next(Type type)
	{
		if (isText_)
		{
			double value = 0;
			if (!(in_ >> value)) fail(path_, "it ends early, or holds what is no number");
			return value;
		}
		switch (type)
		{
			case Type::Int8:
				return read<int8_t>();
			case Type::Uint8:
				return read<uint8_t>();
			case Type::Int16:
				return read<int16_t>();
			case Type::Uint16:
				return read<uint16_t>();
			case Type::Int32:
				return read<int32_t>();
			case Type::Uint32:
				return read<uint32_t>();
			case Type::Float:
				return double(read<float>());
			case Type::Double:
				return read<double>();
		}
		return 0;
	}

private:
	template <class Number>
	Number read()
	{
		static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "as the files");
		Number value{};
		if (!in_.read(reinterpret_cast<char*>(&value), sizeof(value))) fail(path_, "it ends early");
		return value;
	}

	std::istream& in_;
	bool isText_;
	const std::string& path_;
};

Property parseProperty(std::istream& words, const std::string& path)
{
	Property property;
	std::string type;
	words >> type;
	if (type == "list")
	{
		std::string count;
		words >> count >> type;
		property.countType = typeOf(count, path);
	}
	property.type = typeOf(type, path);
	words >> property.name;
	return property;
}

/** Up to and with end_header. */
std::vector<Element> parseHeader(std::istream& in, bool& isText, const std::string& path)
{
	std::vector<Element> elements;
	std::string line, format;
	if (!std::getline(in, line) || line.rfind("ply", 0) != 0) fail(path, "not a PLY file");
	while (std::getline(in, line))
	{
		std::istringstream words(line);
		std::string keyword;
		words >> keyword;
		if (keyword == "end_header")
		{
			if (format != "ascii" && format != "binary_little_endian")
				fail(path, "its format is '" + format + "', not ascii or binary_little_endian");
			isText = format == "ascii";
			return elements;
		}
		if (keyword == "format") words >> format;
		if (keyword == "element")
		{
			auto& element = elements.emplace_back();
			words >> element.name >> element.count;
		}
		if (keyword == "property")
		{
			if (elements.empty()) fail(path, "a property stands before any element");
			elements.back().properties.push_back(parseProperty(words, path));
		}
	}
	fail(path, "its header has no end");
}

void readVertex(const Element& element, Numbers& numbers, Surface& surface)
{
	Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
	for (const Property& property : element.properties)
	{
		double value = 0;
		const double count = property.countType ? numbers.next(*property.countType) : 1;
		for (double i = 0; i < count; i++) value = numbers.next(property.type);
		for (int axis = 0; axis < 3; axis++)
			if (property.name == std::string(1, char('x' + axis))) vertex[axis] = value;
		if (property.name == "label") surface.labels.push_back(value);
	}
	surface.vertices.push_back(vertex);
}

/** The lists of vertex indices become fans of triangles; every other element is passed over. */
void readFace(const Element& element, Numbers& numbers, Surface& surface, const std::string& path)
{
	for (const Property& property : element.properties)
	{
		const double count = property.countType ? numbers.next(*property.countType) : 1;
		std::vector<uint32_t> corners;
		for (double i = 0; i < count; i++)
		{
			const double value = numbers.next(property.type);
			if (element.name != "face" || property.name.rfind("vertex_ind", 0) != 0) continue;
			if (!(value >= 0 && value < double(surface.vertices.size())))
				fail(path, "a face names a vertex that is not there");
			corners.push_back(uint32_t(value));
		}
		for (std::size_t i = 2; i < corners.size(); i++)
			surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
	}
}
}  // namespace

Surface readPly(const std::string& path)
{
	std::ifstream in(path, std::ios::binary);
	if (!in) throw InputError(path + ": cannot be read; does it exist?");
	bool isText = false;
	const auto elements = parseHeader(in, isText, path);
	Numbers numbers(in, isText, path);
	Surface surface;
	for (const Element& element : elements)
		for (std::size_t i = 0; i < element.count; i++)
			if (element.name == "vertex")
				readVertex(element, numbers, surface);
			else
				readFace(element, numbers, surface, path);
	return surface;
}

}  // namespace semloop
