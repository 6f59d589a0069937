#include "StopSignal.h"

#include <csignal>

namespace semloop
{
namespace
{
// A signal handler can reach nothing but a global.
volatile std::sig_atomic_t stopFlag = 0;

void onSignal(int signal)
{
	stopFlag = 1;
	std::signal(signal, SIG_DFL);
}
}  // namespace

void catchStopSignal()
{
	std::signal(SIGINT, onSignal);
	std::signal(SIGTERM, onSignal);
	// A terminal that was closed; nohup wants it ignored.
	if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool stopRequested()
{
	return stopFlag != 0;
}

}  // namespace semloop
