#pragma once

namespace semloop
{
/** `semloop-eval objects OUT --truth X_objects.json [--groundtruth X_groundtruth.tum]
 *  [--align se3|none] [--max-distance M] [--min-iou S] [--json]`; returns the exit code. */
int objectsCommand(int argc, char** argv);

}  // namespace semloop
