#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace mrpt::maps
{
class CSimplePointsMap;
}

namespace semloop
{
class CObjectMap;
class TsdfVolume;

/** The surfaces of a map's objects as points in the world, for algorithms that know point maps. Made when
 *  asked for, and anew when the map has changed; a copy begins empty. */
class SurfacePoints
{
public:
	SurfacePoints() = default;
	SurfacePoints(const SurfacePoints&) {}
	SurfacePoints& operator=(const SurfacePoints&) { return *this; }

	/** One point a cell of 2 cm, at the mean of the surface points in it. Stays until the next call after
	 *  a change of the map. */
	const mrpt::maps::CSimplePointsMap& of(const CObjectMap& map) const;

private:
	mutable std::mutex mutex_;
	mutable uint64_t fingerprint_ = 0;
	mutable std::shared_ptr<const mrpt::maps::CSimplePointsMap> points_;
	// So that no new volume gets the address of one that is gone and looks the same.
	mutable std::vector<std::weak_ptr<const TsdfVolume>> volumes_;
};

}  // namespace semloop
