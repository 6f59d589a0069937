#pragma once

#include <cstdint>
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

	/** The one that was made last when map and observation look the same: objects, poses, number of
	 *  observations, options; time, boxes, scores, masks, and where the arrays lie. */
	std::shared_ptr<const ObservationLikelihood> of(
		const CObjectMap& map, const CObservationInstances& observation) const;

private:
	mutable std::mutex mutex_;
	mutable uint64_t fingerprint_ = 0;
	mutable std::shared_ptr<const ObservationLikelihood> last_;
};

}  // namespace semloop
