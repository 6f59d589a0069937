#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/loop_closure/LoopDetector.h>
#include <semloop/pose_graph/PoseGraph.h>

#include <optional>
#include <string>
#include <vector>

namespace semloop
{
/** Two objects that a verdict says are one, as they were before the correction. */
struct MatchedObjects
{
	ObjectId query = 0, target = 0;
	std::string queryLabel, targetLabel;
	mrpt::math::TPoint3D queryCentre, targetCentre;  //!< in the (drifted) world [m]
};

/** One attempt to close a loop: a line of loops.jsonl. */
struct LoopRecord
{
	std::size_t frame = 0;  //!< camera node at which it was tried
	mrpt::Clock::time_point time;
	std::size_t localMapSince = 0;   //!< camera node from which on the local map is
	std::optional<PosePrior> prior;  //!< the detector's
	LoopVerdict verdict;
	/** Of the correction, see DriftPrior; when the detector accepted. */
	std::optional<double> driftSigmas;
	std::vector<MatchedObjects> matched;             //!< verdict.matches in detail
	std::optional<OptimizationReport> optimization;  //!< when accepted
};

/** How many attempts came to this. */
std::size_t countLoops(const std::vector<LoopRecord>& loops, LoopVerdict::Decision decision);

}  // namespace semloop
