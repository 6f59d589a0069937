#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "RayCaster.h"
#include "TsdfProjection.h"

namespace semloop
{
namespace
{
/** The pixels that are cast. */
struct CastGrid
{
	cv::Rect box;
	int stride = 1;
	int columns = 0, rows = 0;

	static CastGrid over(const ImageBounds& bounds, const cv::Size& image, int maxSamples)
	{
		CastGrid grid;
		const cv::Rect tight = bounds.pixels(image, 0);
		if (tight.empty()) return grid;
		// A sample more on each side, so that the mask's contour closes.
		grid.stride = std::max(1, (std::max(tight.width, tight.height) - 1) / (maxSamples - 2) + 1);
		grid.box = bounds.pixels(image, grid.stride);
		grid.columns = (grid.box.width - 1) / grid.stride + 1;
		grid.rows = (grid.box.height - 1) / grid.stride + 1;
		return grid;
	}
};

/** Of the solid part of each block that is in front of the camera, with a voxel's margin. */
std::vector<ImageBounds> solidBounds(const TsdfBlocks& blocks, const VoxelProjection& projection)
{
	std::vector<ImageBounds> result;
	for (const auto& block : blocks)
	{
		const auto& summary = block.summary;
		if (!summary.solid) continue;
		const auto corner = [](const std::array<int8_t, 3>& a)
		{ return Eigen::Vector3f(a[0], a[1], a[2]); };
		const Eigen::Vector3f first = firstVoxel(block.index);
		const auto bounds = projection.bounds(
			first + corner(summary.solidMin) - Eigen::Vector3f::Ones(),
			first + corner(summary.solidMax) + Eigen::Vector3f::Ones());
		if (bounds.zMax > VoxelProjection::nearPlane) result.push_back(bounds);
	}
	return result;
}

std::vector<DepthInterval> rasterize(const std::vector<ImageBounds>& blocks, const CastGrid& grid)
{
	std::vector<DepthInterval> intervals(static_cast<std::size_t>(grid.columns) * grid.rows);
	const auto sample = [&](float pixel, int origin, int last)
	{
		const float s = (pixel - static_cast<float>(origin)) / static_cast<float>(grid.stride);
		return static_cast<int>(std::clamp(s, -1.F, static_cast<float>(last)));
	};
	for (const auto& b : blocks)
	{
		if (b.uMax < static_cast<float>(grid.box.x) || b.vMax < static_cast<float>(grid.box.y))
			continue;
		const int left = std::max(sample(b.uMin, grid.box.x, grid.columns), 0);
		const int right = sample(b.uMax, grid.box.x, grid.columns - 1);
		const int top = std::max(sample(b.vMin, grid.box.y, grid.rows), 0);
		const int bottom = sample(b.vMax, grid.box.y, grid.rows - 1);
		for (int r = top; r <= bottom; ++r)
			for (int c = left; c <= right; ++c)
			{
				auto& interval = intervals[r * grid.columns + c];
				interval.min = std::min(interval.min, std::max(b.zMin, VoxelProjection::nearPlane));
				interval.max = std::max(interval.max, b.zMax);
			}
	}
	return intervals;
}

/** Contour of the hits at full resolution: bilinear between the cast pixels, at least one half. */
InstanceMask maskOfHits(const cv::Mat& depth, const CastGrid& grid, const cv::Size& image)
{
	const int s = grid.stride;
	std::vector<InstanceMask::Run> runs;
	std::vector<int> blend(grid.columns);
	for (int y = 0; y < grid.box.height; ++y)
	{
		const int r = std::min(y / s, grid.rows - 1), fy = std::min(y - r * s, s);
		const float* const upper = depth.ptr<float>(r);
		const float* const lower = depth.ptr<float>(std::min(r + 1, grid.rows - 1));
		for (int c = 0; c < grid.columns; ++c)
			blend[c] = (upper[c] > 0 ? s - fy : 0) + (lower[c] > 0 ? fy : 0);

		const auto row = static_cast<uint16_t>(grid.box.y + y);
		int begin = -1;
		for (int x = 0; x <= grid.box.width; ++x)
		{
			bool set = false;
			if (x < grid.box.width)
			{
				const int c = std::min(x / s, grid.columns - 1), fx = std::min(x - c * s, s);
				const int next = std::min(c + 1, grid.columns - 1);
				set = 2 * (blend[c] * (s - fx) + blend[next] * fx) >= s * s;
			}
			if (set && begin < 0) begin = x;
			if (!set && begin >= 0)
			{
				runs.push_back(
					{row, static_cast<uint16_t>(grid.box.x + begin),
					 static_cast<uint16_t>(grid.box.x + x)});
				begin = -1;
			}
		}
	}
	return InstanceMask(image, std::move(runs));
}

}  // namespace

std::optional<SurfaceExtent> ObjectPrediction::extent(const mrpt::img::TCamera& camera) const
{
	std::vector<mrpt::math::TPoint3Df> points;
	for (int r = 0; r < depth.rows; ++r)
		for (int c = 0; c < depth.cols; ++c)
		{
			const float z = depth.at<float>(r, c);
			if (!(z > 0)) continue;
			points.emplace_back(
				static_cast<float>((box.x + c * stride - camera.cx()) / camera.fx()) * z,
				static_cast<float>((box.y + r * stride - camera.cy()) / camera.fy()) * z, z);
		}
	return extentOf(points);
}

std::optional<ObjectPrediction> TsdfVolume::raycast(
	const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_object,
	int maxSamples) const
{
	if (maxSamples < 4) throw UsageError("ray casting: maxSamples must be at least 4");
	const cv::Size image(static_cast<int>(camera.ncols), static_cast<int>(camera.nrows));
	const auto voxelSize = static_cast<float>(options_.voxelSize);

	const auto blocks = solidBounds(blocks_, VoxelProjection(camera, T_camera_object, voxelSize));
	ImageBounds all;
	for (const auto& bounds : blocks) all.unite(bounds);
	const auto grid = CastGrid::over(all, image, maxSamples);
	if (grid.box.empty()) return std::nullopt;
	const auto intervals = rasterize(blocks, grid);

	const RigidTransform T(-T_camera_object);
	RayCaster caster(
		blocks_, voxelSize, T.translation / voxelSize - Eigen::Vector3f::Constant(0.5F));
	ObjectPrediction prediction;
	prediction.box = grid.box;
	prediction.stride = grid.stride;
	prediction.depth = cv::Mat(grid.rows, grid.columns, CV_32FC1, cv::Scalar(0));
	bool hit = false;
	for (int r = 0; r < grid.rows; ++r)
		for (int c = 0; c < grid.columns; ++c)
		{
			const auto& interval = intervals[r * grid.columns + c];
			if (!(interval.min <= interval.max)) continue;
			const auto x =
				static_cast<float>((grid.box.x + c * grid.stride - camera.cx()) / camera.fx());
			const auto y =
				static_cast<float>((grid.box.y + r * grid.stride - camera.cy()) / camera.fy());
			const Eigen::Vector3f direction = T.rotation * Eigen::Vector3f(x, y, 1) / voxelSize;
			const float z = caster.cast(direction, interval);
			prediction.depth.at<float>(r, c) = z;
			hit = hit || z > 0;
		}
	if (!hit) return std::nullopt;
	prediction.mask = maskOfHits(prediction.depth, grid, image);
	if (prediction.mask.empty()) return std::nullopt;
	return prediction;
}

}  // namespace semloop
