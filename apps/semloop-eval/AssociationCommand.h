#pragma once

namespace semloop
{
/** `semloop-eval association OUT --truth INSTANCES.rawlog [--minimum-pixels N] [--json]`; returns the
 *  exit code. */
int associationCommand(int argc, char** argv);

}  // namespace semloop
