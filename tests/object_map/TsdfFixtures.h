#pragma once

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "AnalyticScene.h"

namespace semloop::testing
{
constexpr double radius = 0.2, voxel = 0.01;

inline TsdfVolume sphereFromAllAround()
{
	TsdfVolume volume(options(voxel));
	for (const auto& pose : posesAllAround(1.0)) fuse(volume, {sphere(radius)}, pose);
	return volume;
}

inline Eigen::Vector3d eigen(const mrpt::math::TPoint3Df& p)
{
	return {p.x, p.y, p.z};
}

/** Root mean square and largest distance of the surface points to the sphere [m]. */
inline std::pair<double, double> sphereError(
	const std::vector<SurfacePoint>& points,
	const Eigen::Vector3d& centre = Eigen::Vector3d::Zero())
{
	double sum = 0, largest = 0;
	for (const auto& point : points)
	{
		const double e = std::abs((eigen(point.position) - centre).norm() - radius);
		sum += e * e;
		largest = std::max(largest, e);
	}
	return {std::sqrt(sum / static_cast<double>(points.size())), largest};
}

inline std::vector<uint8_t> bytesOf(const TsdfVolume& volume)
{
	mrpt::io::CMemoryStream stream;
	auto archive = mrpt::serialization::archiveFrom(stream);
	volume.serializeTo(archive);
	const auto* const data = static_cast<const uint8_t*>(stream.getRawBufferData());
	return {data, data + stream.getTotalBytesCount()};
}

inline TsdfVolume volumeOf(const std::vector<uint8_t>& bytes)
{
	mrpt::io::CMemoryStream stream;
	stream.assignMemoryNotOwn(bytes.data(), bytes.size());
	auto archive = mrpt::serialization::archiveFrom(stream);
	TsdfVolume volume;
	volume.serializeFrom(archive);
	return volume;
}
}  // namespace semloop::testing
