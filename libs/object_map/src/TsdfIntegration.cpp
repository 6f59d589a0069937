#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "BlockFusion.h"
#include "DepthMeasurements.h"
#include "TsdfProjection.h"
#include "TsdfSampler.h"

namespace semloop
{
namespace
{
void checkFrame(const RgbdFrame& frame, const InstanceMask& mask)
{
	const auto fail = [](const std::string& what) { throw InputError("TSDF fusion: " + what); };
	if (frame.depth.type() != CV_32FC1) fail("the depth image must be CV_32FC1 in metres");
	if (mask.imageSize() != frame.depth.size()) fail("mask and depth image differ in size");
	if (!frame.color.empty() &&
		(frame.color.type() != CV_8UC3 || frame.color.size() != frame.depth.size()))
		fail("the colour image must be CV_8UC3 of the size of the depth image");
	if (!(frame.camera.fx() > 0 && frame.camera.fy() > 0))
		fail("the camera has no focal length; calibrate it");
}

/** 0 when no masked pixel has depth [m]. */
float nearestMaskedDepth(const cv::Mat& depth, const InstanceMask& mask)
{
	float nearest = 0;
	for (const auto& run : mask.runs())
	{
		const auto* const row = depth.ptr<float>(run.row);
		for (int x = run.begin; x < run.end; ++x)
			if (row[x] > VoxelProjection::nearPlane && (nearest == 0 || row[x] < nearest))
				nearest = row[x];
	}
	return nearest;
}

/** The pixels that can say something about the blocks there are, and about those that the mask adds. */
cv::Rect fusionRegion(
	const TsdfBlocks& blocks, const VoxelProjection& projection, const cv::Rect& maskBox,
	int maskMargin, const cv::Size& image)
{
	cv::Rect region;
	if (!maskBox.empty())
	{
		region =
			maskBox + cv::Size(2 * maskMargin, 2 * maskMargin) - cv::Point(maskMargin, maskMargin);
		region &= cv::Rect({0, 0}, image);
	}
	ImageBounds seen;
	for (const auto& block : blocks)
	{
		const Eigen::Vector3f first = firstVoxel(block.index);
		const auto bounds = projection.bounds(first, first.array() + (TsdfBlock::side - 1));
		if (bounds.zMin > VoxelProjection::nearPlane) seen.unite(bounds);
	}
	if (seen.zMax > 0)
	{
		const cv::Rect visible = seen.pixels(image, 0);
		if (!visible.empty()) region = region.empty() ? visible : region | visible;
	}
	return region;
}

}  // namespace

void TsdfVolume::integrate(
	const RgbdFrame& frame, const InstanceMask& mask, const mrpt::poses::CPose3D& T_object_camera)
{
	checkFrame(frame, mask);
	const auto voxelSize = static_cast<float>(options_.voxelSize);
	const VoxelProjection projection(frame.camera, -T_object_camera, voxelSize);

	// A block reaches so many pixels beyond the mask at most.
	const float nearest = nearestMaskedDepth(frame.depth, mask);
	const auto focal = static_cast<float>(std::max(frame.camera.fx(), frame.camera.fy()));
	const float blockDiagonal = 1.8F * TsdfBlock::side * voxelSize;
	const auto margin = nearest > 0 ? std::min(blockDiagonal * focal / nearest, 1000.F) : 0.F;
	const cv::Rect maskBox = nearest > 0 ? mask.boundingBox() : cv::Rect();
	const cv::Rect region =
		fusionRegion(blocks_, projection, maskBox, static_cast<int>(margin), frame.depth.size());
	if (region.empty()) return;
	const DepthMeasurements measurements(frame, mask, region);

	if (nearest > 0)
	{
		makeRoom();
		const float voxelPixels = voxelSize * focal / nearest;
		allocateBand(
			frame.camera, mask, T_object_camera, measurements,
			std::clamp(static_cast<int>(2 * voxelPixels), 1, TsdfBlock::side));
	}
	const BlockFusion fusion(projection, measurements, options_);
	for (auto& block : blocks_)
		if (fusion.fuse(block)) summarize(block);
}

void TsdfVolume::allocateBand(
	const mrpt::img::TCamera& camera, const InstanceMask& mask,
	const mrpt::poses::CPose3D& T_object_camera, const DepthMeasurements& measurements,
	int pixelStride)
{
	const RigidTransform T(T_object_camera);
	const double blockSize = options_.voxelSize * TsdfBlock::side;
	const Eigen::Vector3f origin = T.translation / static_cast<float>(blockSize);

	// Depths of the band that are sampled, half a block apart at most; neighbouring pixels mostly hit
	// the same blocks.
	const int samples = 1 + static_cast<int>(std::ceil(4 * options_.truncation / blockSize));
	std::vector<float> offsets(samples);
	for (int i = 0; i < samples; ++i)
		offsets[i] = static_cast<float>(options_.truncation * (2.0 * i / (samples - 1) - 1));
	std::vector<BlockIndex> last(samples, BlockIndex{BlockIndex::limit, 0, 0});  // no block's

	const int top = mask.boundingBox().y;
	for (const auto& run : mask.runs())
	{
		if ((run.row - top) % pixelStride != 0) continue;
		const auto y = static_cast<float>((run.row - camera.cy()) / camera.fy());
		for (int u = run.begin; u < run.end; u += pixelStride)
		{
			const float depth = measurements.at(u, run.row).depth;
			if (depth <= 0) continue;
			const auto x = static_cast<float>((u - camera.cx()) / camera.fx());
			const Eigen::Vector3f direction =
				T.rotation * Eigen::Vector3f(x, y, 1) / static_cast<float>(blockSize);
			for (int i = 0; i < samples; ++i)
			{
				const Eigen::Vector3f at = origin + direction * (depth + offsets[i]);
				if (!(at.cwiseAbs().maxCoeff() < BlockIndex::limit)) continue;
				const BlockIndex index{floorToInt(at.x()), floorToInt(at.y()), floorToInt(at.z())};
				if (!(index == last[i])) allocate(index);
				last[i] = index;
			}
		}
	}
}

}  // namespace semloop
