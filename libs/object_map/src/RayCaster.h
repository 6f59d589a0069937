#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "TsdfSampler.h"

namespace semloop
{
/** Where along a ray the surface may be, as depth [m]. */
struct DepthInterval
{
	float min = std::numeric_limits<float>::infinity();
	float max = 0;
};

/** Rays q(z) = origin + z direction in grid coordinates, z the depth along the optical axis. */
class RayCaster
{
public:
	RayCaster(const TsdfBlocks& blocks, float voxelSize, const Eigen::Vector3f& origin)
		: sampler_(blocks), inverseVoxel_(1 / voxelSize), origin_(origin)
	{
	}

	/** Depth of the first surface that is entered from its front; 0 when there is none. */
	float cast(const Eigen::Vector3f& direction, const DepthInterval& interval)
	{
		const float voxelStep = 1 / direction.norm();
		float z = interval.min, inFront = -1, distanceInFront = 0;
		while (z <= interval.max)
		{
			const Eigen::Vector3f q = origin_ + z * direction;
			const auto voxel = sampler_.nearest(q);
			if (!voxel.block)
			{
				inFront = -1;
				z = std::max(blockExit(q, direction, z), z) + 0.1F * voxelStep;
				continue;
			}
			const float d = voxel.distance();
			if (d >= 0)
			{
				inFront = z;
				distanceInFront = d;
				z += voxelStep * std::max(1.F, 0.8F * d * inverseVoxel_);
			}
			else if (d < 0)
			{
				if (inFront >= 0)
					return zeroCrossing(direction, {inFront, distanceInFront}, {z, d});
				z += voxelStep;
			}
			else  // unknown
			{
				inFront = -1;
				z += 2 * voxelStep;
			}
		}
		return 0;
	}

private:
	/** Depth at which the ray leaves the block of q. */
	float blockExit(const Eigen::Vector3f& q, const Eigen::Vector3f& direction, float z) const
	{
		constexpr auto side = static_cast<float>(TsdfBlock::side);
		float exit = std::numeric_limits<float>::infinity();
		for (int axis = 0; axis < 3; ++axis)
		{
			if (direction[axis] == 0) continue;
			const float low = std::floor((q[axis] + 0.5F) / side) * side - 0.5F;
			const float wall = direction[axis] > 0 ? low + side : low;
			exit = std::min(exit, z + (wall - q[axis]) / direction[axis]);
		}
		return exit;
	}

	float valueAt(const Eigen::Vector3f& q)
	{
		const float d = sampler_.trilinear(q);
		return std::isnan(d) ? sampler_.nearest(q).distance() : d;
	}

	struct Sample
	{
		float z = 0, distance = 0;  //!< [m]
	};

	/** Between samples in front and behind: false position, as the distance saturates. The first
	 *  guess comes from the nearest voxels, the next ones are interpolated. */
	float zeroCrossing(const Eigen::Vector3f& direction, Sample front, Sample back)
	{
		const auto guess = [&] {
			return front.z + (back.z - front.z) * front.distance / (front.distance - back.distance);
		};
		for (int i = 0; i < 2; ++i)
		{
			const float z = guess();
			const float d = valueAt(origin_ + z * direction);
			if (std::isnan(d) || d == 0) return z;
			(d > 0 ? front : back) = {z, d};
		}
		return guess();
	}

	TsdfSampler sampler_;
	float inverseVoxel_;
	Eigen::Vector3f origin_;
};

}  // namespace semloop
