#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/LikelihoodCache.h>
#include <semloop/object_map/ObservationLikelihood.h>

#include <algorithm>

#include "Fingerprint.h"

namespace semloop
{
namespace
{
constexpr std::size_t kMostEntries = 4;  // cameras of a robot, with room

void addObservation(Fingerprint& fingerprint, const CObservationInstances& observation)
{
	fingerprint.add(&observation);
	fingerprint.add(observation.timestamp);
	fingerprint.add(observation.sensorPose);
	fingerprint.add(observation.labels);
	const auto& camera = observation.camera;
	for (const double value : {camera.fx(), camera.fy(), camera.cx(), camera.cy()})
		fingerprint.add(value);
	for (const double value : camera.dist) fingerprint.add(value);
	fingerprint.add(camera.ncols);
	fingerprint.add(camera.nrows);
	for (const auto& instance : observation.instances)
	{
		for (const int side :
			 {instance.box.x, instance.box.y, instance.box.width, instance.box.height})
			fingerprint.add(side);
		for (const auto& [label, score] : instance.labelScores)
		{
			fingerprint.add(label);
			fingerprint.add(score);
		}
		fingerprint.add(instance.mask.area());
		fingerprint.add(instance.mask.runs().data());
		fingerprint.add(instance.embedding.data());
		fingerprint.add(instance.depth ? instance.depth->depth.data : nullptr);
	}
}
}  // namespace

std::shared_ptr<const ObservationLikelihood> LikelihoodCache::of(
	const CObjectMap& map, const CObservationInstances& observation) const
{
	Fingerprint fingerprint;
	const auto& options = map.likelihoodOptions;
	for (const double value : {options.unexplained, options.positionScale, options.maxDepth})
		fingerprint.add(value);
	fingerprint.add(map);
	addObservation(fingerprint, observation);
	const std::lock_guard lock(mutex_);
	const auto known = std::find_if(
		recent_.begin(), recent_.end(),
		[&](const Entry& entry) { return entry.fingerprint == fingerprint.value(); });
	if (known != recent_.end()) return known->likelihood;
	if (recent_.size() == kMostEntries) recent_.pop_front();
	recent_.push_back(
		{fingerprint.value(),
		 std::make_shared<ObservationLikelihood>(map, observation, map.likelihoodOptions)});
	return recent_.back().likelihood;
}

}  // namespace semloop
