#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/system/COutputLogger.h>
#include <semloop/association/InstanceTracker.h>
#include <semloop/object_map/AssociationRecord.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/odometry/Odometry.h>
#include <semloop/pose_graph/PoseGraph.h>
#include <semloop/slam/CameraCorrection.h>
#include <semloop/slam/DriftPrior.h>
#include <semloop/slam/KeyFrames.h>
#include <semloop/slam/LocalMap.h>
#include <semloop/slam/LoopCloser.h>
#include <semloop/slam/LoopRecord.h>
#include <semloop/slam/ObjectMapper.h>
#include <semloop/slam/SlamFrame.h>
#include <semloop/slam/SlamOptions.h>
#include <semloop/slam/StageTimings.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace semloop
{
/** Object-level RGB-D SLAM with semantic loop closure: the paper's pipeline, one frame at a time.
 *
 *  The world: z up (by gravity when the accelerometer is known), its origin at the first camera. */
class SemanticSlam
{
public:
	/** Makes and configures the modules that [modules] names; throws UsageError on a bad
	 *  configuration. The logger gets what a person may want to know while it runs. */
	SemanticSlam(
		const mrpt::config::CConfigFileBase& config, mrpt::system::COutputLogger& logger,
		StageTimings& timings);

	/** One frame, in order of time. */
	void process(const SlamFrame& frame);
	/** @name The two halves of process(): tracking may run ahead, in another thread.
	 * @{ */
	/** Off-the-shelf RGB-D odometry. */
	OdometryEstimate track(const SlamFrame& frame);
	/** The rest. A frame without instances needs no images here. */
	void integrate(const SlamFrame& frame, const OdometryEstimate& odometry);
	/** @} */
	/** A last optimisation and clean-up of the map. */
	void finish();

	/** @name Results
	 * @{ */
	const CObjectMap& map() const { return *map_; }
	const PoseGraph& poseGraph() const { return *poseGraph_; }
	const std::vector<LoopRecord>& loops() const { return loops_; }
	/** Every detection that went into the map, in order of time; objects as they are now. */
	std::vector<AssociationRecord> associations() const;
	Trajectory trajectory() const;  //!< optimised T_world_camera of every frame
	const Trajectory& odometryTrajectory() const { return odometryTrajectory_; }
	/** For map.simplemap and other maps of MRPT. */
	const std::vector<KeyFrame>& keyFrames() const { return keyFrames_->all(); }
	std::size_t frameCount() const { return odometryTrajectory_.size(); }
	std::size_t segmentedFrameCount() const { return segmentedFrames_; }
	std::size_t lostFrameCount() const { return lostFrames_; }
	std::size_t detectionCount() const { return detections_; }
	const SlamOptions& options() const { return options_; }
	/** @} */

private:
	void makeModules(const mrpt::config::CConfigFileBase& config);
	void makeMap(const mrpt::config::CConfigFileBase& config);
	void feelGravity(const mrpt::obs::CObservation& observation);
	void adoptLabels(const CObservationInstances& instances);
	void placeFirstCamera(const RgbdFrame& frame);
	void addCamera(const RgbdFrame& frame, const OdometryEstimate& odometry);
	void addObservations(const std::vector<ObjectObservation>& seen);
	void remember(
		const CObservationInstances& instances, const std::vector<TrackedInstance>& tracked,
		const std::vector<ObjectObservation>& seen);
	void maintainMap();
	std::vector<MatchedObjects> matchedObjects(const LoopVerdict& verdict) const;
	void closeLoop(mrpt::Clock::time_point time);
	/** What odometry says of the local map against the oldest part of the rest; empty while there is none. */
	std::optional<PosePrior> priorOfTheRest() const;
	/** The same against these objects, which are not in the local map. */
	PosePrior priorOf(const std::vector<ObjectId>& objects) const;
	mrpt::math::TPoint3D localCentroid() const;  //!< of the local map's centres
	/** How improbable the correction is, see DriftPrior. */
	double driftSigmas(const LoopVerdict& verdict) const;
	std::size_t frameAt(mrpt::Clock::time_point time) const;
	void followOptimizedCamera();

	mrpt::poses::CPose3D cameraPose() const
	{
		return T_world_odom_ + T_odom_camera_ + correction_.T_odometry_camera();
	}
	NodeId cameraNode() const { return NodeId::camera(frameCount() - 1); }

	mrpt::system::COutputLogger& logger_;
	StageTimings& timings_;
	ModuleNames modules_;
	SlamOptions options_;

	std::shared_ptr<Odometry> odometry_;
	std::shared_ptr<MatchingCost> matchingCost_;
	std::shared_ptr<PoseGraph> poseGraph_;
	CObjectMap::Ptr map_;
	LocalMap localMap_;
	std::unique_ptr<InstanceTracker> tracker_;
	std::unique_ptr<ObjectMapper> mapper_;
	std::shared_ptr<LoopDetector> loopDetector_;
	std::unique_ptr<LoopCloser> loopCloser_;

	mrpt::poses::CPose3D T_world_firstCamera_;
	mrpt::poses::CPose3D T_world_odom_;  //!< follows the loop closures
	mrpt::poses::CPose3D T_odom_camera_;
	CameraCorrection correction_;              //!< of the odometry's pose, by the objects in view
	std::optional<mrpt::math::TVector3D> up_;  //!< in the robot's frame, from the accelerometer
	DriftPrior driftPrior_;
	Trajectory odometryTrajectory_;
	std::vector<LoopRecord> loops_;
	std::vector<AssociationRecord> associations_;  //!< object: as first associated
	/** Detections that had no object yet, by their track. */
	std::map<uint64_t, std::vector<AssociationRecord>> unassociated_;
	std::unique_ptr<KeyFrames> keyFrames_;
	std::size_t segmentedFrames_ = 0;
	std::size_t lostFrames_ = 0;
	std::size_t detections_ = 0;
};

}  // namespace semloop
