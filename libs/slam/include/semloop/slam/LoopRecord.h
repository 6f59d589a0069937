#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <optional>

namespace semloop
{
/** One attempt to close a loop: a line of loops.jsonl. */
struct LoopRecord
{
	std::size_t frame = 0;  //!< camera node at which it was tried
	mrpt::Clock::time_point time;
	LoopVerdict verdict;
	std::optional<OptimizationReport> optimization;  //!< when accepted
};

}  // namespace semloop
