#include <semloop/config/ExceptionMessage.h>

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
	const std::string text = e.what(), mark = "Message:";
	const auto at = text.find(mark);
	const std::string message = at == std::string::npos ? "" : lineFrom(text, at + mark.size());
	return message.empty() ? lineFrom(text, 0) : message;
}

}  // namespace semloop
