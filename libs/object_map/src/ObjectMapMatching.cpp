#include <mrpt/maps/CSimplePointsMap.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

// What algorithms that know point maps ask of any map: answered by the objects' surface points.

namespace semloop
{
namespace
{
using mrpt::maps::CMetricMap;
using mrpt::maps::CPointsMap;

/** Throws InputError for a map that has no points, as a grid map. */
const CPointsMap& requirePoints(const CMetricMap* map)
{
	if (const auto* const points = dynamic_cast<const CPointsMap*>(map)) return *points;
	if (const auto* const points = map ? map->getAsSimplePointsMap() : nullptr) return *points;
	throw InputError(
		std::string(map ? map->GetRuntimeClass()->className : "no map") +
		": has no points that could be matched with an object map; give a point map or an object "
		"map");
}
}  // namespace

const mrpt::maps::CSimplePointsMap* CObjectMap::getAsSimplePointsMap() const
{
	return &surfacePoints_.of(*this);
}

void CObjectMap::determineMatching2D(
	const CMetricMap* otherMap, const mrpt::poses::CPose2D& otherMapPose,
	mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
	mrpt::maps::TMatchingExtraResults& extraResults) const
{
	getAsSimplePointsMap()->determineMatching2D(
		&requirePoints(otherMap), otherMapPose, correspondences, params, extraResults);
}

void CObjectMap::determineMatching3D(
	const CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
	mrpt::tfest::TMatchingPairList& correspondences, const mrpt::maps::TMatchingParams& params,
	mrpt::maps::TMatchingExtraResults& extraResults) const
{
	getAsSimplePointsMap()->determineMatching3D(
		&requirePoints(otherMap), otherMapPose, correspondences, params, extraResults);
}

float CObjectMap::compute3DMatchingRatio(
	const CMetricMap* otherMap, const mrpt::poses::CPose3D& otherMapPose,
	const mrpt::maps::TMatchingRatioParams& params) const
{
	return getAsSimplePointsMap()->compute3DMatchingRatio(
		&requirePoints(otherMap), otherMapPose, params);
}

float CObjectMap::squareDistanceToClosestCorrespondence(float x0, float y0) const
{
	return getAsSimplePointsMap()->squareDistanceToClosestCorrespondence(x0, y0);
}

}  // namespace semloop
