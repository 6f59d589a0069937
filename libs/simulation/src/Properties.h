#pragma once

#include <map>
#include <string>

namespace semloop
{
/** Keys and values, in UTF-8, of a Java property file in ISO-8859-1 (java.util.Properties.load):
 *  `key=value`, `key:value` or `key value`, comments after # and !, lines continued by a backslash,
 *  escapes \t \n \r \f \uXXXX. Of repeated keys the last counts. Throws InputError, naming the line,
 *  for a \u without four hexadecimal digits. */
std::map<std::string, std::string> parseProperties(const std::string& latin1);

}  // namespace semloop
