#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/association/ConfusionMatrix.h>
#include <semloop/loop_closure/GraphMatcher.h>
#include <semloop/loop_closure/PosePrior.h>
#include <semloop/observations/RgbdFrame.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** What a loop detector is asked: is the local map (query) part of the rest (target)? Both are in one,
 *  drifted, world. */
struct LoopQuery
{
	const CObjectMap& map;
	std::set<ObjectId> query, target;  //!< objects of the local map; all others
	/** About no correction at all; without one nothing is known of the drift. */
	std::optional<PosePrior> prior = {};
	PriorOfObjects priorOf = {};  //!< may be empty; never wider than `prior`
	std::size_t firstFrame = 0;   //!< of the local map
	/** Of any frame, as the pose graph has it now; may be empty where only objects are asked about. */
	std::function<mrpt::poses::CPose3D(std::size_t frame)> T_world_camera = {};
};

/** A camera of the local map as an earlier one sees it. */
struct CameraMatch
{
	std::size_t query = 0, target = 0;    //!< frames
	mrpt::poses::CPose3D T_target_query;  //!< of the cameras' optical frames
	/** Inverse covariance of PoseEdge's residual (translation [m], rotation [rad]). */
	Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
	std::size_t inliers = 0;  //!< features that agree with it
};

/** Where one matched object of the query belongs, as measured on that object alone. */
struct MatchAlignment
{
	mrpt::poses::CPose3D T_target_query;  //!< between the worlds, as LoopVerdict's
	/** Inverse covariance of a small motion d = (translation [m], rotation vector [rad]) of the query
	 *  object about its centre: T_target_query C exp(d), C the query's centre with its world's axes. */
	Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

/** Outcome of matching a local map against the global map. */
struct LoopVerdict
{
	enum class Decision
	{
		Accepted,
		Rejected,
		Ambiguous
	};

	Decision decision = Decision::Rejected;
	std::string reason;  //!< one line for a person, with the numbers behind it
	/** The consistent ones, query id first; an object is in one match at most. */
	std::vector<std::pair<ObjectId, ObjectId>> matches;
	mrpt::poses::CPose3D T_target_query;  //!< meaningful when accepted, or with hasPose
	bool hasPose = false;                 //!< T_target_query is the best guess
	double probability = 0.0;  //!< that T_target_query is right, [0, 1]; 0 when not estimated
	/** As many as matches, in their order: the local map has its own drift, so each object has its own
	 *  correction. Empty when the detector measures none; T_target_query then holds for all. */
	std::vector<MatchAlignment> alignments;
	/** Of a detector of appearance, which matches frames, not objects; empty otherwise. */
	std::vector<CameraMatch> cameras;
	/** As the graphs were matched, before surfaces were compared; query id first. */
	std::vector<std::pair<ObjectId, ObjectId>> candidates;
	bool graphsMatch = false;  //!< they, or the images, are a detection, whatever the surfaces say
	std::size_t queryObjects = 0;  //!< objects in the local map
	// Empty when it did not come to that.
	std::optional<double> matchedEdgeShare;  //!< matched edges / edges of the query graph, [0, 1]
	std::optional<double> matchingScore;     //!< of the graph matcher
	std::optional<double> evidence;          //!< of the place, see PlaceSearch
	std::optional<double> centreRmse;        //!< of the matched centres under T_target_query [m]
	std::optional<double> runnerUp;          //!< evidence of the best other place / ours, [0, 1]
	std::optional<double> alignmentFitness;  //!< share of aligned surface points, [0, 1]
	std::optional<double> alignmentRmse;     //!< of the aligned surfaces [m]
};

/** Recognises the local map (query) in the rest of the map (target). A module. */
class LoopDetector : public mrpt::rtti::CObject
{
	DEFINE_VIRTUAL_MRPT_OBJECT(LoopDetector)

public:
	virtual void configure(
		const mrpt::config::CConfigFileBase& config, const std::string& section) = 0;
	/** How the network mistakes labels for each other, when that is known; before the first question. */
	virtual void setConfusionMatrix(const ConfusionMatrix& /*confusion*/) {}
	/** Every frame that has instances, in order: detectors of appearance remember it. The images may be
	 *  gone after the call. */
	virtual void addFrame(std::size_t /*frame*/, const RgbdFrame& /*images*/) {}
	/** Not const: what does not change from one question to the next may be kept. */
	virtual LoopVerdict detect(const LoopQuery& query) = 0;
};

const char* toString(LoopVerdict::Decision decision);  //!< "accepted", "rejected", "ambiguous"

}  // namespace semloop
