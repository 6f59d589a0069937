#pragma once

#include <stdexcept>
#include <string>

namespace semloop
{
/** An input that cannot be used. what() is one line: file, place, what is wrong, remedy.
 *  Programs print it and exit with 1. */
class InputError : public std::runtime_error
{
 public:
	using std::runtime_error::runtime_error;
};

/** Wrong usage: an argument or a configuration key. what() is one line. Programs exit with 2. */
class UsageError : public std::runtime_error
{
 public:
	using std::runtime_error::runtime_error;
};

}  // namespace semloop
