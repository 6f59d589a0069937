#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfBlocks.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <opencv2/core/types.hpp>

namespace semloop
{
/** Of a pose, for inner loops. Throws InputError when the pose is not finite. */
struct RigidTransform
{
	explicit RigidTransform(const mrpt::poses::CPose3D& pose)
		: rotation(pose.getRotationMatrix().asEigen().cast<float>()),
		  translation(
			  static_cast<float>(pose.x()), static_cast<float>(pose.y()),
			  static_cast<float>(pose.z()))
	{
		if (!rotation.allFinite() || !translation.allFinite())
			throw InputError("TSDF volume: the pose is not finite; check the trajectory");
	}
	Eigen::Matrix3f rotation;
	Eigen::Vector3f translation;
};

/** Where something may be seen: pixels and depths along the optical axis, both ends included. */
struct ImageBounds
{
	float uMin = 1e9F, uMax = -1e9F;
	float vMin = 1e9F, vMax = -1e9F;
	float zMin = 1e9F, zMax = -1e9F;  //!< [m]

	void unite(const ImageBounds& o)
	{
		uMin = std::min(uMin, o.uMin), uMax = std::max(uMax, o.uMax);
		vMin = std::min(vMin, o.vMin), vMax = std::max(vMax, o.vMax);
		zMin = std::min(zMin, o.zMin), zMax = std::max(zMax, o.zMax);
	}
	/** The pixels whose centres may be touched, margin pixels more on each side, cut to the image. */
	cv::Rect pixels(const cv::Size& image, int margin) const
	{
		const auto clip = [](float a, int size)
		{ return static_cast<int>(std::floor(std::clamp(a, -1.F, static_cast<float>(size)))); };
		const int left = std::max(clip(uMin, image.width) - margin, 0);
		const int top = std::max(clip(vMin, image.height) - margin, 0);
		const int right = std::min(clip(uMax, image.width) + 2 + margin, image.width);
		const int bottom = std::min(clip(vMax, image.height) + 2 + margin, image.height);
		return {left, top, std::max(right - left, 0), std::max(bottom - top, 0)};
	}
};

/** Voxel coordinates (of the grid: voxel i is centred at i) to homogeneous pixels (u z, v z, z). It is
 *  affine, so that a row of voxels is projected by adding steps. */
class VoxelProjection
{
public:
	/** Nearer than this nothing is measured or predicted [m]. */
	static constexpr float nearPlane = 0.05F;

	VoxelProjection(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_object,
		float voxelSize)
	{
		Eigen::Matrix3f intrinsics = Eigen::Matrix3f::Identity();
		intrinsics(0, 0) = static_cast<float>(camera.fx());
		intrinsics(1, 1) = static_cast<float>(camera.fy());
		intrinsics(0, 2) = static_cast<float>(camera.cx());
		intrinsics(1, 2) = static_cast<float>(camera.cy());
		const RigidTransform T(T_camera_object);
		const Eigen::Vector3f centre = Eigen::Vector3f::Constant(0.5F * voxelSize);
		origin_ = intrinsics * (T.rotation * centre + T.translation);
		steps_ = intrinsics * T.rotation * voxelSize;
	}

	Eigen::Vector3f operator()(float x, float y, float z) const
	{
		return origin_ + steps_ * Eigen::Vector3f(x, y, z);
	}
	const Eigen::Vector3f& origin() const { return origin_; }
	const Eigen::Matrix3f& steps() const { return steps_; }

	/** Of the box with these corners. Where it reaches behind the near plane, every pixel may see it. */
	ImageBounds bounds(const Eigen::Vector3f& low, const Eigen::Vector3f& high) const
	{
		ImageBounds result;
		for (int corner = 0; corner < 8; ++corner)
		{
			const Eigen::Vector3f h = (*this)(
				corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
				corner & 4 ? high.z() : low.z());
			const float u = h.x() / h.z(), v = h.y() / h.z();
			result.unite({u, u, v, v, h.z(), h.z()});
		}
		if (result.zMin < nearPlane)
		{
			result.uMin = result.vMin = -1e9F;
			result.uMax = result.vMax = 1e9F;
		}
		return result;
	}

private:
	Eigen::Vector3f origin_;
	Eigen::Matrix3f steps_;
};

/** Grid coordinates of a block's first voxel. */
inline Eigen::Vector3f firstVoxel(const BlockIndex& index)
{
	return Eigen::Vector3f(
			   static_cast<float>(index.x), static_cast<float>(index.y),
			   static_cast<float>(index.z)) *
		   TsdfBlock::side;
}

}  // namespace semloop
