#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/LikelihoodCache.h>
#include <semloop/object_map/ObservationLikelihood.h>

#include "Fingerprint.h"

namespace semloop
{
namespace
{
void addObservation(Fingerprint& fingerprint, const CObservationInstances& observation)
{
	fingerprint.add(&observation);
	fingerprint.add(observation.timestamp);
	for (std::size_t i = 0; i < 6; ++i) fingerprint.add(observation.sensorPose[i]);
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
	if (!last_ || fingerprint_ != fingerprint.value())
	{
		last_ = std::make_shared<ObservationLikelihood>(map, observation, map.likelihoodOptions);
		fingerprint_ = fingerprint.value();
	}
	return last_;
}

}  // namespace semloop
