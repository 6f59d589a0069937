#include "Properties.h"

#include <semloop/config/Error.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace semloop
{
namespace
{
constexpr std::string_view kBlank = " \t\f";

void appendUtf8(std::string& out, uint32_t code)
{
	const auto tail = [&](int shift) { out += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
	if (code < 0x80)
		out += static_cast<char>(code);
	else if (code < 0x800)
	{
		out += static_cast<char>(0xC0 | (code >> 6));
		tail(0);
	}
	else if (code < 0x10000)
	{
		out += static_cast<char>(0xE0 | (code >> 12));
		tail(6);
		tail(0);
	}
	else
	{
		out += static_cast<char>(0xF0 | (code >> 18));
		tail(12), tail(6);
		tail(0);
	}
}

/** The 16 bits of \uXXXX, whose digits start at `at`. */
uint32_t hexadecimal(std::string_view text, std::size_t at)
{
	uint32_t code = 0;
	const std::string_view digits = text.substr(std::min(at, text.size()), 4);
	const auto [end, error] =
		std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
	if (digits.size() != 4 || error != std::errc() || end != digits.data() + 4)
		throw InputError("\\u" + std::string(digits) + " is not \\u and four hexadecimal digits");
	return code;
}

char unescaped(char letter)
{
	switch (letter)
	{
		case 't':
			return '\t';
		case 'n':
			return '\n';
		case 'r':
			return '\r';
		case 'f':
			return '\f';
		default:
			return letter;
	}
}

bool isSurrogate(uint32_t code, uint32_t base)
{
	return (code & 0xFC00U) == base;
}

std::string decode(std::string_view text)
{
	std::string out;
	for (std::size_t i = 0; i < text.size(); i++)
	{
		if (text[i] != '\\')
			appendUtf8(out, static_cast<unsigned char>(text[i]));
		else if (++i < text.size() && text[i] == 'u')
		{
			uint32_t code = hexadecimal(text, i + 1);
			i += 4;
			// Characters beyond 16 bits are two escapes.
			if (isSurrogate(code, 0xD800) && text.substr(i + 1, 2) == "\\u")
			{
				const uint32_t low = hexadecimal(text, i + 3);
				if (isSurrogate(low, 0xDC00))
				{
					code = 0x10000 + ((code & 0x3FF) << 10) + (low & 0x3FF);
					i += 6;
				}
			}
			appendUtf8(out, code >= 0xD800 && code < 0xE000 ? 0xFFFD : code);
		}
		else if (i < text.size())
			appendUtf8(out, static_cast<unsigned char>(unescaped(text[i])));
	}
	return out;
}

std::size_t endOfKey(std::string_view line)
{
	std::size_t i = 0;
	for (; i < line.size() && std::string_view("=: \t\f").find(line[i]) == line.npos; i++)
		if (line[i] == '\\') i++;
	return std::min(i, line.size());
}

std::string_view withoutLeadingBlank(std::string_view text)
{
	return text.substr(std::min(text.find_first_not_of(kBlank), text.size()));
}

bool isContinued(std::string_view line)
{
	std::size_t backslashes = 0;
	while (backslashes < line.size() && line[line.size() - 1 - backslashes] == '\\') backslashes++;
	return backslashes % 2 == 1;
}

/** Cuts the next line, ended by \n, \r or both, off the text. */
std::string_view nextLine(std::string_view& rest)
{
	const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
	const std::string_view line = rest.substr(0, end);
	rest.remove_prefix(end);
	rest.remove_prefix(rest.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, rest.size()));
	return line;
}

}  // namespace

std::map<std::string, std::string> parseProperties(const std::string& latin1)
{
	std::map<std::string, std::string> result;
	std::size_t lineNumber = 0;
	for (std::string_view rest = latin1; !rest.empty();)
	{
		std::string logical(withoutLeadingBlank(nextLine(rest)));
		const std::size_t first = ++lineNumber;
		if (logical.empty() || logical[0] == '#' || logical[0] == '!') continue;
		while (isContinued(logical))
		{
			logical.pop_back();
			if (rest.empty()) break;
			logical += withoutLeadingBlank(nextLine(rest));
			lineNumber++;
		}
		const std::string_view line = logical;
		const std::size_t keyEnd = endOfKey(line);
		std::string_view value = withoutLeadingBlank(line.substr(keyEnd));
		if (!value.empty() && (value[0] == '=' || value[0] == ':'))
			value = withoutLeadingBlank(value.substr(1));
		try
		{
			result[decode(line.substr(0, keyEnd))] = decode(value);
		}
		catch (const InputError& e)
		{
			throw InputError("line " + std::to_string(first) + ": " + e.what());
		}
	}
	return result;
}

}  // namespace semloop
