#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/object_map/SemanticGraph.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace semloop
{
/** When an object of the map can be a real one. */
struct ObjectGate
{
	double centreDistance = 0.5;  //!< at most [m]; or
	double boxIou = 0.1;          //!< more than
};

/** An object of the map that stands for a real one. */
struct ObjectMatch
{
	ObjectId estimate = 0;
	ObjectId truth = 0;
	double centreError = 0;        //!< [m]
	std::optional<double> boxIou;  //!< empty when one of the two has no extent
	bool sameLabel = false;
};

struct ObjectEvaluation
{
	std::size_t estimated = 0;         //!< objects of the map
	std::size_t truth = 0;             //!< real ones that were to be seen
	std::size_t found = 0;             //!< of these, the matched ones
	std::vector<ObjectMatch> matches;  //!< by the estimate's id
	/** Unmatched objects of the map whose centre is inside the box of a real object that has a match, or,
	 *  where that has no extent, within the gate's distance of its centre. By id. */
	std::vector<ObjectId> duplicates;
	std::optional<double> precision;      //!< matches / estimated
	std::optional<double> recall;         //!< found / truth
	ErrorSummary centreError;             //!< [m]
	std::optional<double> meanBoxIou;     //!< of the matches that have one
	std::optional<double> labelAccuracy;  //!< share of the matches with the right label
};

/** Compares the map's objects, carried into the true world by T_truth_estimate, with the real ones.
 *
 *  Objects are matched one to one inside the gate, as many as possible; of these choices the one with
 *  the least sum of centre distances counts, where a wrong label costs as much as the gate's distance.
 *  Boxes stand upright in the true world: of an orientation only the yaw is used. Real objects with 0
 *  observations, in a file that tells observations of any, were never to be seen: they can be matched,
 *  but are not missed. */
ObjectEvaluation evaluateObjects(
	const SemanticGraph& estimate, const SemanticGraph& truth,
	const mrpt::poses::CPose3D& T_truth_estimate = {}, const ObjectGate& gate = {});

}  // namespace semloop
