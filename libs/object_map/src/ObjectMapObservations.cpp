#include <mrpt/poses/Lie/SO.h>
#include <semloop/association/Assignment.h>
#include <semloop/association/MaskedSurface.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include <algorithm>
#include <utility>

#include "MapConfusion.h"
#include "SegmentedFrame.h"

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;

/** L of Eq. (3): a row for each predicted object, a column for each detection. */
CostMatrix costMatrix(
	const CObjectMap& map, const std::vector<PredictedObject>& predicted,
	const SegmentedFrame& segmented)
{
	std::vector<AssociationItem> detections(segmented.instances.size());
	std::vector<std::vector<std::vector<float>>> embeddings(detections.size());
	for (std::size_t k = 0; k < detections.size(); ++k)
	{
		const Instance& instance = segmented.instances[k];
		if (!instance.embedding.empty()) embeddings[k] = {instance.embedding};
		detections[k].mask = &instance.mask;
		detections[k].labelScores = &instance.labelScores;
		detections[k].embeddings = &embeddings[k];
		detections[k].surface =
			MaskedSurface(instance.mask, segmented.frame.depth, segmented.frame.camera).extent();
	}
	SemanticMatchingCost cost;
	cost.setConfusionMatrix(mapConfusion(map.labels()));
	return matchingCosts(cost, map.landmarks(predicted, segmented.frame.camera), detections);
}

/** Out of those that wait; null when none does. */
template <class Observation>
std::shared_ptr<Observation> takeNearest(
	std::vector<std::shared_ptr<Observation>>& waiting, const CPose3D& sensorPose)
{
	const auto turn = [&](const CPose3D& pose)
	{ return mrpt::poses::Lie::SO<3>::log((sensorPose - pose).getRotationMatrix()).norm(); };
	const auto distance = [&](const auto& observation)
	{ return observation->sensorPose.distanceTo(sensorPose) + turn(observation->sensorPose); };
	const auto nearest = std::min_element(
		waiting.begin(), waiting.end(),
		[&](const auto& a, const auto& b) { return distance(a) < distance(b); });
	if (nearest == waiting.end()) return nullptr;
	const auto result = *nearest;
	waiting.erase(nearest);
	return result;
}

bool hasCrops(const CObservationInstances& observation)
{
	return std::any_of(
		observation.instances.begin(), observation.instances.end(),
		[](const Instance& instance) { return instance.depth.has_value(); });
}
}  // namespace

void UnpairedObservations::startAt(mrpt::Clock::time_point time)
{
	if (time != time_) *this = {};
	time_ = time;
}

std::optional<std::pair<UnpairedObservations::Scan, UnpairedObservations::Instances>>
UnpairedObservations::add(const Scan& scan)
{
	startAt(scan->timestamp);
	if (const auto instances = takeNearest(instances_, scan->sensorPose))
		return std::pair(scan, instances);
	scans_.push_back(scan);
	return std::nullopt;
}

std::optional<std::pair<UnpairedObservations::Scan, UnpairedObservations::Instances>>
UnpairedObservations::add(const Instances& instances)
{
	startAt(instances->timestamp);
	if (const auto scan = takeNearest(scans_, instances->sensorPose))
		return std::pair(scan, instances);
	instances_.push_back(instances);
	return std::nullopt;
}

bool CObjectMap::internal_insertObservation(
	const mrpt::obs::CObservation& observation, const std::optional<const CPose3D>& robotPose)
{
	const auto* const instances = dynamic_cast<const CObservationInstances*>(&observation);
	if (instances && hasCrops(*instances))
	{
		SegmentedFrame segmented = SegmentedFrame::fromCrops(*instances);
		auto& all = segmented.instances;
		all.erase(
			std::remove_if(all.begin(), all.end(), [](const Instance& i) { return !i.depth; }),
			all.end());
		return insert(segmented, instances->labels, robotPose.value_or(CPose3D()));
	}
	const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&observation);
	if (!instances && !scan) return false;
	const auto pair = scan ? unpaired_.add(std::make_shared<CObservation3DRangeScan>(*scan))
						   : unpaired_.add(std::make_shared<CObservationInstances>(*instances));
	if (!pair) return false;
	return insert(
		SegmentedFrame::fromScan(*pair->first, *pair->second), pair->second->labels,
		robotPose.value_or(CPose3D()));
}

bool CObjectMap::insert(
	const SegmentedFrame& segmented, const LabelSet& labels, const CPose3D& T_world_robot)
{
	if (objects_.empty()) labels_ = labels;
	if (!(labels_ == labels))
		throw InputError(
			"instances of " + std::to_string(labels.size()) +
			" labels for a map with another set of " + std::to_string(labels_.size()) +
			": use the same segmentation network for the whole map");

	const CPose3D T_world_camera = T_world_robot + segmented.frame.T_robot_camera;
	const auto predicted = predict(segmented.frame.camera, T_world_camera, segmented.frame.depth);
	const auto assignment =
		solveAssignment(costMatrix(*this, predicted, segmented), insertionOptions.gate);

	std::set<ObjectId> seen;
	std::vector<bool> isMatched(segmented.instances.size(), false);
	for (const auto& [row, column] : assignment.matches)
	{
		isMatched[column] = true;
		const ObjectId id = predicted[row].id;
		if (fuse(id, segmented.frame, segmented.instances[column], T_world_camera)) seen.insert(id);
	}
	for (std::size_t k = 0; k < segmented.instances.size(); ++k)
		if (!isMatched[k])
			if (const auto id = addObject(segmented.frame, segmented.instances[k], T_world_camera))
				seen.insert(*id);
	markCovisible(seen);
	updateExistence(predicted, segmented.frame, seen);
	const bool removed = !removeUnsupported().empty();
	return removed || !seen.empty();
}

double CObjectMap::internal_computeObservationLikelihood(
	const mrpt::obs::CObservation& observation, const CPose3D& takenFrom) const
{
	const auto* instances = dynamic_cast<const CObservationInstances*>(&observation);
	if (!instances) return 0;
	return likelihood_.of(*this, *instances)->log(takenFrom);
}

bool CObjectMap::internal_canComputeObservationLikelihood(
	const mrpt::obs::CObservation& observation) const
{
	return dynamic_cast<const CObservationInstances*>(&observation) != nullptr;
}

}  // namespace semloop
