#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace semloop
{
/** Polls until it holds; throws after a minute, which no working program needs. */
template <typename Condition>
void waitUntil(const std::string& what, const Condition& holds)
{
	const auto giveUp = std::chrono::steady_clock::now() + std::chrono::minutes(1);
	while (!holds())
	{
		if (std::chrono::steady_clock::now() > giveUp)
			throw std::runtime_error("waited in vain until " + what);
		std::this_thread::sleep_for(std::chrono::milliseconds(2));
	}
}

/** A program that runs beside the test, its stdout and stderr in files; killed when it is still running
 *  at the end. */
class ChildProcess
{
public:
	ChildProcess(std::vector<std::string> command, const std::string& out, const std::string& err)
	{
		std::vector<char*> arguments;
		for (auto& word : command) arguments.push_back(word.data());
		arguments.push_back(nullptr);
		pid_ = fork();
		if (pid_ < 0) throw std::runtime_error("cannot fork");
		if (pid_ > 0) return;
		redirect(out, STDOUT_FILENO);
		redirect(err, STDERR_FILENO);
		// Whoever runs the tests in the background may have them ignore Ctrl-C.
		signal(SIGINT, SIG_DFL);
		execv(arguments[0], arguments.data());
		_exit(127);
	}
	~ChildProcess()
	{
		if (reaped_) return;
		kill(pid_, SIGKILL);
		waitpid(pid_, &status_, 0);
	}
	ChildProcess(const ChildProcess&) = delete;
	ChildProcess& operator=(const ChildProcess&) = delete;

	/** False once it has ended. */
	bool isRunning()
	{
		if (!reaped_) reaped_ = waitpid(pid_, &status_, WNOHANG) == pid_;
		return !reaped_;
	}
	void send(int signalNumber) const { kill(pid_, signalNumber); }
	/** Whether the signal has a handler now, as Linux tells (SigCgt). */
	bool catches(int signalNumber) const
	{
		std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
		for (std::string line; std::getline(status, line);)
			if (line.rfind("SigCgt:", 0) == 0)
				return std::stoull(line.substr(7), nullptr, 16) >> (signalNumber - 1) & 1;
		return false;
	}

	/** Waits for its end. The exit code; -1 when a signal killed it. */
	int exitCode()
	{
		waitUntil("the program ends", [&] { return !isRunning(); });
		return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
	}
	/** The signal that killed it; 0 when it ended by itself. */
	int killedBy()
	{
		waitUntil("the program ends", [&] { return !isRunning(); });
		return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
	}

private:
	static void redirect(const std::string& path, int descriptor)
	{
		const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
		dup2(file, descriptor);
		close(file);
	}

	pid_t pid_ = -1;
	int status_ = 0;
	bool reaped_ = false;
};

}  // namespace semloop
