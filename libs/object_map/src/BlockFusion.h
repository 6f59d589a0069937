#pragma once

#include <semloop/object_map/TsdfVolume.h>

#include <array>

#include "DepthMeasurements.h"
#include "TsdfProjection.h"

namespace semloop
{
/** Fuses the measurements of one frame into blocks (the formulas of TsdfVolume::integrate), a slice of
 *  64 voxels at a time: its loops are written without branches, so that compilers vectorise them. */
class BlockFusion
{
public:
	/** Keeps references to the first two. */
	BlockFusion(
		const VoxelProjection& projection, const DepthMeasurements& measurements,
		const TsdfOptions& options);

	/** True when a voxel changed. */
	bool fuse(TsdfBlock& block) const;

private:
	static constexpr int lanes = TsdfBlock::side * TsdfBlock::side;
	static constexpr int maxColorMemory = 16;  // views; the colour is a mean over about so many
	template <typename T>
	using Slice = std::array<T, lanes>;

	/** What the pixels nearest to a slice's voxels say. */
	struct Reading
	{
		Slice<int32_t> entry;        //!< of the measurements; their border outside the region
		Slice<float> voxelDepth;     //!< [m]
		Slice<float> depth, weight;  //!< measured, see Measurement
	};

	bool fuseSlice(TsdfBlock& block, int first, const Eigen::Vector3f& start) const;
	void project(const Eigen::Vector3f& start, Reading& reading) const;
	void read(Reading& reading) const;
	/** Is any of the voxels not hidden behind a measured surface? */
	bool anySeen(const Reading& reading) const;
	void average(TsdfBlock& block, int first, const Reading& reading) const;
	void vote(TsdfBlock& block, int first, const Reading& reading) const;
	/** Running mean over the views so far, of a bounded number; black is no colour yet. */
	void blendColor(TsdfBlock& block, int voxel, int entry) const;

	const VoxelProjection& projection_;
	const DepthMeasurements& measurements_;
	float truncation_, maxWeight_;
	float behindScale_;  // the weight falls from a voxel behind the surface to 0 at -truncation
	Slice<float> offsetU_, offsetV_, offsetZ_;          // homogeneous, of a slice's voxels
	std::array<int, maxColorMemory + 1> reciprocal_{};  // 2^16 / n, rounded up
};

}  // namespace semloop
