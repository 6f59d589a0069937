#include <mrpt/maps/CSimplePointsMap.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/object_map/SurfacePoints.h>

#include <array>
#include <cmath>
#include <map>

#include "Fingerprint.h"

namespace semloop
{
namespace
{
using mrpt::maps::CSimplePointsMap;

constexpr double kCell = 0.02;  // [m]

/** Points of a cell. */
struct Cell
{
	mrpt::math::TPoint3D sum{0, 0, 0};
	int count = 0;
};

std::shared_ptr<const CSimplePointsMap> pointsOf(const CObjectMap& map)
{
	auto points = std::make_shared<CSimplePointsMap>();
	for (const auto& [id, object] : map.objects())
	{
		std::map<std::array<int64_t, 3>, Cell> cells;
		for (const auto& vertex : object.volume->surface())
		{
			const auto p =
				object.T_world_object.composePoint(mrpt::math::TPoint3D(vertex.position));
			const auto index = [](double x) { return int64_t(std::floor(x / kCell)); };
			auto& cell = cells[{index(p.x), index(p.y), index(p.z)}];
			cell.sum = cell.sum + p;
			cell.count++;
		}
		for (const auto& [index, cell] : cells)
		{
			const auto p = cell.sum * (1.0 / cell.count);
			points->insertPoint(float(p.x), float(p.y), float(p.z));
		}
	}
	return points;
}
}  // namespace

const CSimplePointsMap& SurfacePoints::of(const CObjectMap& map) const
{
	Fingerprint fingerprint;
	fingerprint.add(map);
	const std::lock_guard lock(mutex_);
	if (!points_ || fingerprint_ != fingerprint.value())
	{
		points_ = pointsOf(map);
		volumes_.clear();
		for (const auto& [id, object] : map.objects()) volumes_.push_back(object.volume);
		fingerprint_ = fingerprint.value();
	}
	return *points_;
}

}  // namespace semloop
