#include <semloop/config/ExceptionMessage.h>

#include <regex>

namespace semloop
{
namespace
{
/** Without the blanks before it. */
std::string lineFrom(const std::string& text, std::size_t position)
{
	const auto begin = text.find_first_not_of(' ', position);
	return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
}
}  // namespace

std::string exceptionMessage(const std::exception& e)
{
	const std::string text = e.what();
	// MRPT wraps exceptions in exceptions, each with a call stack.
	std::size_t begin = 0;
	for (const std::string mark :
		 {"==== MRPT exception ====\n", "Original exception:\n", "Message:"})
	{
		const auto at = text.rfind(mark);
		if (at != std::string::npos && at >= begin) begin = at + mark.size();
	}
	static const std::regex place(R"(^\S+:\d+: \[.*?\] )");  // file:line: [function]
	const std::string message = std::regex_replace(lineFrom(text, begin), place, "");
	return message.empty() ? lineFrom(text, 0) : message;
}

}  // namespace semloop
