#include <semloop/association/Assignment.h>
#include <semloop/association/MaskedSurface.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/Rectifier.h>

#include <algorithm>
#include <cmath>

namespace semloop
{
namespace
{
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

constexpr double kCorrectLabels = 0.8;  // of the confusion matrix, which nobody gave us
constexpr double kUnexplained = 0.1;    // share of detections that a good map does not explain

/** Instances with depth crops as a frame: depth known inside the crops only. */
struct CroppedFrame
{
	RgbdFrame frame;
	std::vector<Instance> instances;
};

CroppedFrame frameFromCrops(const CObservationInstances& observation)
{
	CroppedFrame result;
	const cv::Size size = observation.imageSize();
	result.frame.time = observation.timestamp;
	result.frame.camera = observation.camera;
	result.frame.T_robot_camera = robotFromCamera(observation.sensorPose);
	// The observation has no colours: one a label tells the objects apart.
	result.frame.color = cv::Mat(size, CV_8UC3, cv::Scalar::all(160));
	result.frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar::all(0));
	for (const auto& instance : observation.instances)
	{
		if (!instance.depth) continue;
		cv::Mat metres;
		instance.depth->depth.convertTo(metres, CV_32FC1, double(instance.depth->unit));
		metres.copyTo(result.frame.depth(instance.box), metres > 0);
		const uint32_t hash = (instance.label() + 1) * 2654435761u;
		const cv::Scalar color(
			64 + (hash >> 8) % 160, 64 + (hash >> 16) % 160, 64 + (hash >> 24) % 160);
		result.frame.color(instance.box).setTo(color, instance.mask.decode(instance.box));
		result.instances.push_back(instance);
	}
	return result;
}

/** Checked, rectified, and with a frame. */
CroppedFrame prepared(const CObservationInstances& observation)
{
	observation.validate();
	if (!hasDistortion(observation.camera)) return frameFromCrops(observation);
	return frameFromCrops(*Rectifier().rectify(observation));
}

/** L of Eq. (3): a row for each predicted object, a column for each detection. */
CostMatrix costMatrix(
	const CObjectMap& map, const std::vector<PredictedObject>& predicted,
	const CroppedFrame& cropped)
{
	std::vector<AssociationItem> detections(cropped.instances.size());
	std::vector<std::vector<std::vector<float>>> embeddings(detections.size());
	for (std::size_t k = 0; k < detections.size(); ++k)
	{
		const Instance& instance = cropped.instances[k];
		if (!instance.embedding.empty()) embeddings[k] = {instance.embedding};
		detections[k].mask = &instance.mask;
		detections[k].labelScores = &instance.labelScores;
		detections[k].embeddings = &embeddings[k];
		detections[k].surface =
			MaskedSurface(instance.mask, cropped.frame.depth, cropped.frame.camera).extent();
	}
	SemanticMatchingCost cost;
	cost.setConfusionMatrix(ConfusionMatrix(map.labels(), kCorrectLabels));
	return matchingCosts(cost, map.landmarks(predicted, cropped.frame.camera), detections);
}
}  // namespace

bool CObjectMap::internal_insertObservation(
	const mrpt::obs::CObservation& observation, const std::optional<const CPose3D>& robotPose)
{
	const auto* instances = dynamic_cast<const CObservationInstances*>(&observation);
	if (!instances) return false;
	if (objects_.empty()) labels_ = instances->labels;
	if (!(labels_ == instances->labels))
		throw InputError(
			"instances of " + std::to_string(instances->labels.size()) +
			" labels for a map with another set of " + std::to_string(labels_.size()) +
			": use the same segmentation network for the whole map");
	const CroppedFrame cropped = prepared(*instances);
	if (cropped.instances.empty()) return false;

	const CPose3D T_world_camera = robotPose.value_or(CPose3D()) + cropped.frame.T_robot_camera;
	const auto predicted = predict(cropped.frame.camera, T_world_camera, cropped.frame.depth);
	const auto assignment =
		solveAssignment(costMatrix(*this, predicted, cropped), insertionOptions.gate);

	std::set<ObjectId> seen;
	std::vector<bool> isMatched(cropped.instances.size(), false);
	for (const auto& [row, column] : assignment.matches)
	{
		isMatched[column] = true;
		const ObjectId id = predicted[row].id;
		if (fuse(id, cropped.frame, cropped.instances[column], T_world_camera)) seen.insert(id);
	}
	for (std::size_t k = 0; k < cropped.instances.size(); ++k)
		if (!isMatched[k])
			if (const auto id = addObject(cropped.frame, cropped.instances[k], T_world_camera))
				seen.insert(*id);
	markCovisible(seen);
	updateExistence(predicted, cropped.frame, seen);
	removeUnsupported();
	return !seen.empty();
}

double CObjectMap::internal_computeObservationLikelihood(
	const mrpt::obs::CObservation& observation, const CPose3D& takenFrom) const
{
	const auto* instances = dynamic_cast<const CObservationInstances*>(&observation);
	if (!instances || (!objects_.empty() && !(labels_ == instances->labels))) return 0;
	const CroppedFrame cropped = prepared(*instances);
	const CPose3D T_world_camera = takenFrom + cropped.frame.T_robot_camera;
	const auto predicted = predict(cropped.frame.camera, T_world_camera, cropped.frame.depth);
	const CostMatrix cost = costMatrix(*this, predicted, cropped);
	double logLikelihood = 0;
	for (Eigen::Index k = 0; k < Eigen::Index(cropped.instances.size()); ++k)
	{
		const double best = cost.rows() > 0 ? 1 - cost.col(k).minCoeff() : 0;
		logLikelihood += std::log(kUnexplained + (1 - kUnexplained) * std::clamp(best, 0.0, 1.0));
	}
	return logLikelihood;
}

bool CObjectMap::internal_canComputeObservationLikelihood(
	const mrpt::obs::CObservation& observation) const
{
	return dynamic_cast<const CObservationInstances*>(&observation) != nullptr;
}

}  // namespace semloop
