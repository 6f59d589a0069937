#pragma once

namespace semloop
{
/** From now on the first Ctrl-C (or SIGTERM, or SIGHUP) only raises a flag, so that a program can finish what it
 *  is at and write its results; the second one ends the process at once. */
void catchStopSignal();

bool stopRequested();

}  // namespace semloop
