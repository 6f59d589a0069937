#pragma once

namespace semloop
{
/** `semloop-eval loops OUT/loops.jsonl --truth INSTANCES.rawlog [--common-objects N] [--frames-apart N]
 *  [--minimum-pixels N] [--json]`; returns the exit code. */
int loopsCommand(int argc, char** argv);

}  // namespace semloop
