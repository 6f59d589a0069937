#pragma once

#include <semloop/association/Associator.h>
#include <semloop/association/FrameRegistration.h>
#include <semloop/association/InstanceTracker.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/slam/LocalMap.h>
#include <semloop/slam/StageTimings.h>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace semloop
{
/** One detection that is an object of the map. */
struct ObjectObservation
{
	ObjectId object = 0;
	std::size_t instance = 0;  //!< index in the frame's observation
	uint64_t track = 0;
	/** Its measurements went into the object's volume. Else only its track says what it is. */
	bool fused = true;
};

/** Sec. III-B, object-level data association and fusion: detections that the tracker confirmed are
 *  assigned to the objects' predicted masks by Eq. (1)-(3) and fused; what stays without a match
 *  becomes a new object. */
class ObjectMapper
{
public:
	ObjectMapper(
		CObjectMap::Ptr map, std::shared_ptr<const Associator> associator, StageTimings& timings,
		FrameRegistrationOptions registration = {});

	/** What went into the map, in the order of tracked; two tracks of one object, as when a mask was
	 *  split, are both there. Only objects of the local map are landmarks: the drift since others were
	 *  seen may have put them where another one stands now. The frame is registered to them first, and
	 *  fused where registration() puts the camera.
	 *  @param T_world_expected the camera's optical frame, by all that is known before, with its sigma */
	std::vector<ObjectObservation> update(
		const RgbdFrame& frame, const CObservationInstances& observation,
		const std::vector<TrackedInstance>& tracked, const mrpt::poses::CPose3D& T_world_expected,
		const LocalMap& localMap, const PoseSigma& sigma = {});

	/** What the last frame's detections said about T_world_expected. */
	const FrameRegistration& registration() const { return registered_; }

	/** Tracks and observations of the absorbed object belong to the kept one from now on. */
	void merge(ObjectId kept, ObjectId absorbed);
	void remove(ObjectId id);
	/** What the object has become by all merges so far; a removed one keeps its id. */
	ObjectId mergedInto(ObjectId id) const;

private:
	std::vector<PredictedObject> predict(
		const RgbdFrame& frame, const mrpt::poses::CPose3D& T_world_camera, const cv::Mat& depth,
		const LocalMap& localMap) const;
	/** Fuses the detection into its object, or makes one; empty when neither was possible. */
	std::optional<ObjectObservation> fuse(
		const RgbdFrame& frame, const Instance& instance, const TrackedInstance& tracked,
		std::optional<ObjectId> object, const mrpt::poses::CPose3D& T_world_camera,
		const LocalMap& localMap);

	CObjectMap::Ptr map_;
	std::shared_ptr<const Associator> associator_;
	StageTimings& timings_;
	FrameRegistrationOptions registrationOptions_;
	FrameRegistration registered_;
	std::map<uint64_t, ObjectId> objectOfTrack_;
	std::map<ObjectId, ObjectId> absorbedBy_;
};

}  // namespace semloop
