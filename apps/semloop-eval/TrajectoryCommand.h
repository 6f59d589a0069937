#pragma once

namespace semloop
{
/** `semloop-eval trajectory EST.tum TRUTH.tum [--align se3|none] [--json]`; returns the exit code. */
int trajectoryCommand(int argc, char** argv);

}  // namespace semloop
