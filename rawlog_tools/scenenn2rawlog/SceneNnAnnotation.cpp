#include "SceneNnAnnotation.h"

#include <expat.h>
#include <semloop/config/Error.h>

#include <array>
#include <charconv>
#include <fstream>
#include <memory>
#include <optional>

namespace semloop
{
namespace
{
const char* const kRemedy = "; give the XML of this sequence, as SceneNN published it";

std::string trimmed(const std::string& text)
{
	const char* const blanks = " \t\r\n";
	const auto first = text.find_first_not_of(blanks);
	if (first == std::string::npos) return {};
	return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

class Reader
{
public:
	explicit Reader(const std::string& path) : path_(path), parser_(XML_ParserCreate(nullptr))
	{
		if (!parser_) throw std::bad_alloc();
		XML_SetUserData(parser_.get(), this);
		XML_SetStartElementHandler(parser_.get(), &Reader::startElement);
	}

	SceneNnAnnotation read()
	{
		std::ifstream in(path_, std::ios::binary);
		if (!in) throw InputError(path_ + ": cannot be read; does it exist?");
		std::array<char, 1 << 16> bytes;
		do
		{
			in.read(bytes.data(), bytes.size());
			const auto status =
				XML_Parse(parser_.get(), bytes.data(), int(in.gcount()), in.gcount() == 0);
			// Expat's C code cannot be left by an exception.
			if (!problem_.empty()) throw InputError(problem_);
			if (status != XML_STATUS_OK)
				throw InputError(
					place() + "not readable as XML: " +
					XML_ErrorString(XML_GetErrorCode(parser_.get())) + kRemedy);
		} while (in.gcount() > 0);
		if (annotation_.empty())
			throw InputError(path_ + ": no <label> in it has an id and a text" + kRemedy);
		return annotation_;
	}

private:
	static void startElement(void* reader, const XML_Char* name, const XML_Char** attributes)
	{
		if (std::string(name) == "label") static_cast<Reader*>(reader)->add(attributes);
	}

	void add(const XML_Char** attributes)
	{
		if (!problem_.empty()) return;
		std::optional<std::string> id;
		std::string text;
		for (; *attributes; attributes += 2)
		{
			const std::string name = attributes[0];
			if (name == "id") id = attributes[1];
			if (name == "text") text = trimmed(attributes[1]);
		}
		uint32_t number = 0;
		if (!id)
			stop("a <label> without id");
		else if (!parse(*id, number))
			stop("id '" + *id + "' is no number of a label");
		else if (!text.empty() && !annotation_.emplace(number, text).second)
			stop("id " + *id + " stands for a second time");
	}

	static bool parse(const std::string& text, uint32_t& number)
	{
		const char* const last = text.data() + text.size();
		const auto [end, error] = std::from_chars(text.data(), last, number);
		return error == std::errc() && end == last;
	}

	void stop(const std::string& why)
	{
		problem_ = place() + why + kRemedy;
		XML_StopParser(parser_.get(), XML_FALSE);
	}

	std::string place() const
	{
		return path_ + ":" + std::to_string(XML_GetCurrentLineNumber(parser_.get())) + ": ";
	}

	struct Free
	{
		void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
	};

	const std::string path_;
	const std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_;
	SceneNnAnnotation annotation_;
	std::string problem_;
};

}  // namespace

SceneNnAnnotation readSceneNnAnnotation(const std::string& path)
{
	return Reader(path).read();
}

}  // namespace semloop
