#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/observations/Trajectory.h>

#include <cstddef>
#include <vector>

namespace semloop
{
/** Two trajectories at (about) one time. */
struct PosePair
{
	double time = 0;                //!< of the estimate, since its first pair [s]
	mrpt::poses::CPose3D estimate;  //!< in the estimate's world
	mrpt::poses::CPose3D truth;     //!< in the truth's world
};

/** Pairs every estimated pose with a true one, one to one, no two further apart than
 *  maxTimeDifference [s]: the closest two of all first, as the TUM benchmark's association does.
 *  In order of the estimate's time; empty when nothing fits. */
std::vector<PosePair> associateByTime(
	const Trajectory& estimate, const Trajectory& truth, double maxTimeDifference = 0.02);

/** Statistics of a set of errors, in their unit. All zero for an empty set. */
struct ErrorSummary
{
	std::size_t count = 0;
	double rmse = 0;  //!< sqrt(1/n sum e^2)
	double mean = 0;
	double median = 0;  //!< mean of the middle two when their number is even
	double max = 0;
};

ErrorSummary summarizeErrors(std::vector<double> errors);

enum class TrajectoryAlignment
{
	None,  //!< both trajectories share a world
	Se3    //!< the rigid motion with the least squared distance (Horn 1987, Umeyama 1991), no scale
};

/** Absolute trajectory error (Sturm et al., IROS 2012, Sec. IV-C): of every pair
 *  | trans(truth_i) - trans(T_truth_estimate estimate_i) |. */
struct AbsoluteTrajectoryError
{
	mrpt::poses::CPose3D T_truth_estimate;  //!< the alignment; identity for None
	ErrorSummary translation;               //!< [m]
	std::vector<double> errors;             //!< [m], one a pair, in the order of the pairs
};

/** Throws InputError with fewer than 3 pairs: any two points align. Where the poses lie on a line
 *  (or in a point) one of the equally good alignments is taken. */
AbsoluteTrajectoryError absoluteTrajectoryError(
	const std::vector<PosePair>& pairs, TrajectoryAlignment alignment = TrajectoryAlignment::Se3);

enum class IntervalUnit
{
	Seconds,
	Metres  //!< travelled along the estimate
};

/** Relative pose error over a fixed interval, as the TUM benchmark's evaluate_rpe.py computes it:
 *  E_i = (estimate_j^-1 estimate_i)^-1 (truth_j^-1 truth_i), where j is the pose nearest to one
 *  interval after i; without the i whose j is the last pose. The paper (Sturm et al., IROS 2012,
 *  Eq. (2)) has the motions from i to j: the angles are the same, the translations are not. */
struct RelativePoseError
{
	double interval = 0;  //!< [s] or [m]
	IntervalUnit unit = IntervalUnit::Seconds;
	ErrorSummary translation;  //!< |trans(E_i)| [m]
	ErrorSummary rotation;     //!< angle of rot(E_i) [rad]
};

/** Poses with no more than an interval behind them have no E_i, so that a short trajectory gives a
 *  summary with count 0. Throws InputError with fewer than 3 pairs and UsageError for an interval
 *  that is not positive. */
RelativePoseError relativePoseError(
	const std::vector<PosePair>& pairs, double interval = 1.0,
	IntervalUnit unit = IntervalUnit::Seconds);

}  // namespace semloop
