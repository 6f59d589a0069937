#include "Application.h"

#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace semloop
{
namespace
{
/** TCLAP prints a wrong call over many lines and goes on: we want one line, and out. */
class ThrowingOutput : public TCLAP::StdOutput
{
public:
	void failure(TCLAP::CmdLineInterface& commandLine, TCLAP::ArgException& e) override
	{
		// Without a culprit TCLAP names " " or "undefined".
		const bool named =
			e.argId().find_first_not_of(' ') != std::string::npos && e.argId() != "undefined";
		const std::string where = named ? e.argId() + ": " : "";
		throw UsageError(where + e.error() + "; see " + commandLine.getProgramName() + " --help");
	}
};
}  // namespace

int runApplication(const std::string& name, const std::function<int()>& body)
{
	try
	{
		return body();
	}
	catch (const UsageError& e)
	{
		std::cerr << name << ": " << e.what() << "\n";
		return kUsage;
	}
	catch (const InputError& e)
	{
		std::cerr << name << ": " << e.what() << "\n";
		return kFailed;
	}
	catch (const std::exception& e)
	{
		std::cerr << name << ": " << exceptionMessage(e) << "\n";
		return kFailed;
	}
}

bool parseArguments(TCLAP::CmdLine& commandLine, int argc, char** argv)
{
	ThrowingOutput output;
	delete commandLine.getOutput();  // TCLAP forgets its own when another one is set
	commandLine.setOutput(&output);
	return commandLine.parse(argc, const_cast<const char**>(argv));
}

void leaveAtOnce(int exitCode)
{
	std::cout.flush();
	std::cerr.flush();
	std::fflush(nullptr);
	std::_Exit(exitCode);
}

void requireFile(const std::string& path, const std::string& remedy)
{
	if (!std::filesystem::is_regular_file(path))
		throw InputError(path + ": no such file; " + remedy);
}

void requireWritableFolder(const std::string& path)
{
	std::error_code error;
	std::filesystem::create_directories(path, error);
	const auto probe = std::filesystem::path(path) / ".semloop-write-test";
	if (!std::ofstream(probe))
		throw InputError(path + ": cannot write there; choose another output directory");
	std::filesystem::remove(probe, error);
}

}  // namespace semloop
