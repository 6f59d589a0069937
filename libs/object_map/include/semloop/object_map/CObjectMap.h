#pragma once

#include <mrpt/maps/CMetricMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Options.h>
#include <semloop/object_map/LikelihoodCache.h>
#include <semloop/object_map/Object.h>
#include <semloop/object_map/ObservationLikelihood.h>
#include <semloop/object_map/SurfacePoints.h>
#include <semloop/observations/CObservationInstances.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** How objects are built. */
struct ObjectMapInsertionOptions : Options
{
	double voxelsPerSide = 64;    //!< voxel size = size of the object when first seen / this ...
	double minVoxelSize = 0.005;  //!< ... clipped to this range [m]
	double maxVoxelSize = 0.03;   //!< [m]
	double truncationVoxels = 4;  //!< truncation = this * voxel size
	double maxDepth = 4.0;        //!< further measurements are not fused [m]
	int minPixels = 64;           //!< a mask needs this many pixels of valid depth on the object
	int maxEmbeddings = 10;       //!< |E_j| at most
	double gate =
		0.8;  //!< largest matching cost when the map itself associates (insertObservation)

protected:
	void describe(OptionFields& fields) override;
};

/** When objects are dropped or united. */
struct ObjectMapMaintenanceOptions : Options
{
	double minExistence = 0.1;  //!< below: the object is removed
	double mergeIou =
		0.3;  //!< boxes of two objects of compatible label that overlap more: one object
	double mergeSurfaceOverlap = 0.4;  //!< same, for the share of the smaller surface on the larger
	/** Labels are compatible when the best ones agree, or sum_l min(l_i, l_j) is more than this. */
	double mergeLabelOverlap = 0.3;

protected:
	void describe(OptionFields& fields) override;
};

/** What of a map is drawn. */
struct ObjectMapVisualizationOptions : Options
{
	bool meshes = true;  //!< the objects' surfaces
	bool boxes = true;   //!< round the surfaces
	bool names = true;   //!< label and id
	bool edges = true;   //!< lines between objects that were seen together

protected:
	void describe(OptionFields& fields) override;
};

struct SegmentedFrame;

/** Range scans and instances of one time that wait for each other. With several cameras, instances go
 *  with the scan whose sensor is nearest to theirs on the robot. */
class UnpairedObservations
{
public:
	// Shared, for particle filters copy the map.
	using Scan = std::shared_ptr<const mrpt::obs::CObservation3DRangeScan>;
	using Instances = std::shared_ptr<const CObservationInstances>;

	/** A pair with what came now, which no longer waits; nothing yet. Those of another time before it
	 *  are given up. */
	std::optional<std::pair<Scan, Instances>> add(const Scan& scan);
	std::optional<std::pair<Scan, Instances>> add(const Instances& instances);

private:
	void startAt(mrpt::Clock::time_point time);

	mrpt::Clock::time_point time_;
	std::vector<Scan> scans_;
	std::vector<Instances> instances_;
};

/** What the map expects to see from a camera. */
struct PredictedObject
{
	ObjectId id = 0;
	ObjectPrediction prediction;  //!< occluded parts already removed
	double visibleShare =
		1.0;  //!< visible pixels / pixels without other objects and measured depth, > 0
};

/** The object map as an MRPT metric map: one TSDF volume per object.
 *
 *  Frames: the world is MRPT's (z up); insertObservation() takes robot poses as every metric map
 *  does. The semantic front end calls addObject() / fuse() with camera poses (optical frame).
 *
 *  Copies are cheap: they share the volumes until one of them writes. Two copies must not be
 *  changed from two threads at once. */
class CObjectMap : public mrpt::maps::CMetricMap
{
	DEFINE_SERIALIZABLE(CObjectMap, semloop)

public:
	CObjectMap() = default;

	ObjectMapInsertionOptions insertionOptions;
	ObjectMapMaintenanceOptions maintenanceOptions;
	ObjectMapLikelihoodOptions likelihoodOptions;
	ObjectMapVisualizationOptions visualizationOptions;

	/** @name Objects
	 * @{ */
	const std::map<ObjectId, Object>& objects() const { return objects_; }
	const Object& object(ObjectId id) const;  //!< throws std::out_of_range
	const LabelSet& labels() const { return labels_; }
	void setLabels(const LabelSet& labels) { labels_ = labels; }
	const std::string& labelName(const Object& object) const;

	/** A new object from one rectified detection; empty when its mask has too little valid depth.
	 *  Its frame sits at the centre of the depth seen, axes parallel to the world's. Throws InputError
	 *  when the mask does not fit the frame, or a label is not in labels(). */
	std::optional<ObjectId> addObject(
		const RgbdFrame& frame, const Instance& instance,
		const mrpt::poses::CPose3D& T_world_camera);
	/** Fuses an associated detection into V_j, l_j and E_j. False, and nothing changed, when its mask
	 *  has too little valid depth. Throws as addObject() does, also when the embedding's size differs
	 *  from the object's, and std::out_of_range for an id that the map does not have. */
	bool fuse(
		ObjectId id, const RgbdFrame& frame, const Instance& instance,
		const mrpt::poses::CPose3D& T_world_camera);
	/** Counts one more time that each pair was seen together. */
	void markCovisible(const std::set<ObjectId>& objects);

	/** Predicted masks m_j of the objects in view, nearest first. An object hides what is behind it,
	 *  and so does what the depth image (same camera, may be empty) measures in front of it: by more
	 *  than max(truncation, 3 cm). Objects with nothing left to see are not in the list; with `among`,
	 *  the map holds no others than these. */
	std::vector<PredictedObject> predict(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_world_camera,
		const cv::Mat& depth = {},
		const std::optional<std::set<ObjectId>>& among = std::nullopt) const;
	/** The predictions as Eq. (3) compares them with detections; they point to the map's data and to
	 *  `predicted`. */
	std::vector<AssociationItem> landmarks(
		const std::vector<PredictedObject>& predicted, const mrpt::img::TCamera& camera) const;

	/** Lowers the existence of objects that the depth image looks through, and raises that of the
	 *  associated ones; log-odds, as in occupancy grids (H. Moravec and A. Elfes, ICRA 1985). An object
	 *  that was only not detected, the depth being where it should, stays as it is. */
	void updateExistence(
		const std::vector<PredictedObject>& predicted, const RgbdFrame& frame,
		const std::set<ObjectId>& associated);
	/** Removes what does not exist (any more); returns what went. */
	std::vector<ObjectId> removeUnsupported();
	/** @} */

	/** @name After a loop closure
	 * @{ */
	/** New T_world_object; ids that the map does not have throw std::out_of_range. */
	void moveObjects(const std::map<ObjectId, mrpt::poses::CPose3D>& poses);
	/** Puts `absorbed` into `kept` where both stand now, and removes it. */
	void mergeObjects(ObjectId kept, ObjectId absorbed);
	/** Pairs (kept = older id, absorbed) that are one object. Of compatible labels: their boxes
	 *  (axis-aligned in the world, a voxel wider on each side so that thin things overlap too) have an
	 *  IoU above mergeIou, or more than mergeSurfaceOverlap of the smaller one's surface lies within
	 *  two voxels of the larger one's. Boxes alone would unite neighbours that stand askew. Of other
	 *  labels: both, for a network may call one thing by two names, but two things have no surface in
	 *  common. Each object
	 *  comes once at most; merging changes what overlaps: ask again until there is none. With `among`,
	 *  only pairs of these. */
	std::vector<std::pair<ObjectId, ObjectId>> findDuplicates(
		const std::optional<std::set<ObjectId>>& among = std::nullopt) const;
	/** @} */

	/** @name mrpt::maps::CMetricMap
	 * insertObservation() takes CObservationInstances with depth crops; or without, and the
	 * CObservation3DRangeScan of the same time, in any order, as a CSensoryFrame holds them: then the second of
	 * the two changes the map. It associates them with predict() by Eq. (1)-(3), p(l_k | l_j) being ConfusionMatrix(labels(), 0.8)
	 * as no configuration of a run reaches it, fuses, adds and removes. The likelihood of such an
	 * observation, with depth crops or without, is ObservationLikelihood's; what does not depend on the pose
	 * is kept until another observation, or a changed map, is asked for.
	 * @{ */
	bool isEmpty() const override { return objects_.empty(); }
	/** Writes <prefix>.3Dscene, <prefix>.objmap, <prefix>.json (semloop.graph/1) and
	 *  <prefix>_objects/<id>_<label>.ply; throws InputError. */
	void saveMetricMapRepresentationToFile(const std::string& filePrefix) const override;
	/** Meshes, boxes and names of the objects, and lines for the co-visible pairs: what
	 *  visualizationOptions has; nothing without genericMapParams.enableSaveAs3DObject. */
	void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;
	std::string asString() const override;

	/** The objects' surfaces in the world, one point a cell of 2 cm; stays until the map has changed and
	 *  it is asked for again. Never null. */
	const mrpt::maps::CSimplePointsMap* getAsSimplePointsMap() const override;
	/** As CPointsMap has them, between these points and those of the other map: a point map, or one that
	 *  has getAsSimplePointsMap(). Throw InputError for other maps. */
	void determineMatching2D(
		const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose2D& otherMapPose,
		mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
		mrpt::maps::TMatchingExtraResults& extraResults) const override;
	void determineMatching3D(
		const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
		mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
		mrpt::maps::TMatchingExtraResults& extraResults) const override;
	float compute3DMatchingRatio(
		const mrpt::maps::CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
		const mrpt::maps::TMatchingRatioParams& params) const override;
	/** Of the nearest surface point, seen from above [m^2]. */
	float squareDistanceToClosestCorrespondence(float x0, float y0) const override;
	/** @} */

protected:
	/** Keeps options and labels. */
	void internal_clear() override;
	bool internal_insertObservation(
		const mrpt::obs::CObservation& observation,
		const std::optional<const mrpt::poses::CPose3D>& robotPose = std::nullopt) override;
	double internal_computeObservationLikelihood(
		const mrpt::obs::CObservation& observation,
		const mrpt::poses::CPose3D& takenFrom) const override;
	bool internal_canComputeObservationLikelihood(
		const mrpt::obs::CObservation& observation) const override;

private:
	TsdfVolume& writableVolume(Object& object);
	void requireUsable(const RgbdFrame& frame, const Instance& instance) const;
	bool insert(
		const SegmentedFrame& segmented, const LabelSet& labels,
		const mrpt::poses::CPose3D& T_world_robot);

	std::map<ObjectId, Object> objects_;
	LabelSet labels_;
	ObjectId nextId_ = 0;
	UnpairedObservations unpaired_;
	LikelihoodCache likelihood_;
	SurfacePoints surfacePoints_;

	MAP_DEFINITION_START(CObjectMap)
	semloop::ObjectMapInsertionOptions insertOpts;
	semloop::ObjectMapMaintenanceOptions maintenanceOpts;
	semloop::ObjectMapLikelihoodOptions likelihoodOpts;
	semloop::ObjectMapVisualizationOptions visualizationOpts;
	MAP_DEFINITION_END(CObjectMap)
};

}  // namespace semloop
