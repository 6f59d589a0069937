#pragma once

#include <mrpt/3rdparty/tclap/CmdLine.h>

#include <functional>
#include <string>

namespace semloop
{
/** Exit codes of every program. */
enum ExitCode
{
	kSuccess = 0,
	kFailed = 1,  //!< ran, and failed: the data are at fault
	kUsage = 2    //!< wrong arguments or configuration
};

/** Runs a program's body and turns what it throws into one line on stderr and an exit code:
 *  UsageError 2, anything else 1. */
int runApplication(const std::string& name, const std::function<int()>& body);

/** Parses argv. False when --help or --version was asked for and has been answered: the program is
 *  done. Throws UsageError, with TCLAP's explanation, on wrong arguments. */
bool parseArguments(TCLAP::CmdLine& commandLine, int argc, char** argv);

/** Ends the process with no destructor, for when a thread that cannot be ended uses what they destroy. */
[[noreturn]] void leaveAtOnce(int exitCode);

/** Throws InputError, with the remedy, when a file to read is not there. */
void requireFile(const std::string& path, const std::string& remedy);

/** Makes the folder when it is missing; throws InputError when that fails or nothing can be written
 *  into it. */
void requireWritableFolder(const std::string& path);

}  // namespace semloop
