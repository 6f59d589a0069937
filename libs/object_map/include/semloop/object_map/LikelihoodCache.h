#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

namespace semloop
{
class CObjectMap;
class CObservationInstances;
class ObservationLikelihood;

/** Particle filters ask a map for the likelihood of one observation from a thousand poses: this keeps what
 *  the poses have in common. Can be used from several threads; a copy begins empty. */
class LikelihoodCache
{
public:
	LikelihoodCache() = default;
	LikelihoodCache(const LikelihoodCache&) {}
	LikelihoodCache& operator=(const LikelihoodCache&) { return *this; }

	/** One of the last four that were made when map and observation look the same: labels, objects,
	 *  poses, number of observations, options; time, camera, labels, boxes, scores, masks, and where the
	 *  arrays lie. */
	std::shared_ptr<const ObservationLikelihood> of(
		const CObjectMap& map, const CObservationInstances& observation) const;

private:
	struct Entry
	{
		uint64_t fingerprint;
		std::shared_ptr<const ObservationLikelihood> likelihood;
	};

	mutable std::mutex mutex_;
	mutable std::deque<Entry> recent_;
};

}  // namespace semloop
