#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "TemporaryFolder.h"

namespace semloop
{
struct ShellResult
{
	int code = -1;  //!< exit code; -1: ended by a signal
	std::string out, err;
};

/** Runs a shell command in a folder. */
inline ShellResult shell(const std::string& command, const std::filesystem::path& folder)
{
	const TemporaryFolder output;
	const std::string out = output.file("out"), err = output.file("err");
	const int status = std::system(
		("cd '" + folder.string() + "' && { " + command + "\n} > '" + out + "' 2> '" + err + "'")
			.c_str());
	return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readBytes(out), readBytes(err)};
}

/** Whether a program can be found in PATH. */
inline bool isInstalled(const std::string& program)
{
	return shell("command -v " + program, ".").code == 0;
}

}  // namespace semloop
