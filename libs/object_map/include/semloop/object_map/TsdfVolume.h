#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/img/TColor.h>
#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/association/SurfaceExtent.h>
#include <semloop/object_map/TsdfBlocks.h>
#include <semloop/observations/InstanceMask.h>
#include <semloop/observations/RgbdFrame.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace semloop
{
class DepthMeasurements;

struct SurfacePoint
{
	mrpt::math::TPoint3Df position;  //!< in the object's frame [m]
	mrpt::math::TVector3Df normal;   //!< unit length, pointing out of the object
	mrpt::img::TColor color;
};

/** Vertices in the object's frame [m]; triangles counter-clockwise seen from outside. */
struct TriangleMesh
{
	std::vector<SurfacePoint> vertices;
	std::vector<std::array<uint32_t, 3>> triangles;
};

/** What a camera would see of one object. */
struct ObjectPrediction
{
	InstanceMask mask;  //!< m_j, whole image
	cv::Rect box;       //!< part of the image that was cast, in pixels
	int stride = 1;     //!< every stride-th pixel was cast
	cv::Mat depth;      //!< CV_32FC1, one entry per cast pixel [m], 0 = no surface

	/** As MaskedSurface has it of a detection; empty without surface. */
	std::optional<SurfaceExtent> extent(const mrpt::img::TCamera& camera) const;
};

/** How one object is sampled. */
struct TsdfOptions
{
	double voxelSize = 0.01;   //!< [m]
	double truncation = 0.04;  //!< half width of the band round the surface [m]
	double maxWeight =
		64;  //!< of the running average, so that a moved surface is overwritten in time
	int maxBlocks = 1500;  //!< bounds the memory: 6.4 KB each; what would need more is not fused
};

/** Truncated signed distance of one object, in its own frame, in sparse blocks of 8 x 8 x 8 voxels
 *  that are allocated where a surface was measured (B. Curless and M. Levoy, SIGGRAPH 1996; blocks
 *  after M. Niessner et al., SIGGRAPH Asia 2013; per-object volumes with a foreground probability
 *  per voxel after J. McCormac et al., Fusion++, 3DV 2018).
 *
 *  The signed distance is positive in front of the surface. A voxel belongs to the object when it was
 *  seen more often inside the mask than outside; only those voxels make surface, mesh and prediction. */
class TsdfVolume
{
public:
	/** Throws UsageError unless voxelSize > 0, truncation >= voxelSize, maxWeight > 0, maxBlocks > 0. */
	explicit TsdfVolume(const TsdfOptions& options = {});

	/** Fuses the masked pixels of a rectified frame, and carves. With z the depth of a voxel's centre
	 *  and D the measured depth at its pixel, s = D - z along the optical axis:
	 *
	 *      s >= truncation             free:  d <- (W d + w truncation) / (W + w), in the mask or not
	 *      |s| < truncation, masked    d <- (W d + w s) / (W + w); one more time seen as foreground
	 *      |s| < truncation, unmasked  one more time seen as background
	 *      s <= -truncation            hidden: nothing
	 *
	 *  W <- min(W + w, maxWeight), and the pixel's weight is w = (1 m / z)^2 cos^2(slant), each factor
	 *  within [1/16, 1]; from one voxel behind the surface it falls linearly to 0 at -truncation
	 *  (E. Bylow et al., RSS 2013), as little is known there and a thin object has its other side.
	 *  Blocks are allocated along the band round masked measurements only; carving reaches all blocks.
	 *  Depth that is zero, negative, NaN or infinite is no measurement, nor is the far side of a depth
	 *  edge (a neighbour nearer by 3 %: a mixed pixel or a mask that spills over). Pixels beyond a
	 *  useful depth are the caller's business.
	 *
	 *  An empty mask only carves. An empty colour image leaves the colours. Throws InputError when the
	 *  sizes or types of depth, colour and mask do not fit, the focal length is not positive or the
	 *  pose is not finite (so do merge() and raycast()). */
	void integrate(
		const RgbdFrame& frame, const InstanceMask& mask,
		const mrpt::poses::CPose3D& T_object_camera);

	/** Fuses another volume's surface that lies at T_this_other (resampled trilinearly, weights and
	 *  evidence added). */
	void merge(const TsdfVolume& other, const mrpt::poses::CPose3D& T_this_other);

	/** Casts rays through the pixels where the volume may be seen, at most maxSamples a side (the
	 *  stride follows from that); empty when nothing is hit. A surface is seen from its front only.
	 *  depth(r, c) belongs to pixel (box.x + c stride, box.y + r stride); between cast pixels the mask
	 *  is the bilinear interpolation of hits and misses. Throws UsageError when maxSamples < 4. */
	std::optional<ObjectPrediction> raycast(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_object,
		int maxSamples = 64) const;

	/** Zero crossings on the voxel edges, with normals from the gradient, in a fixed order. */
	std::vector<SurfacePoint> surface() const;
	/** Marching cubes (W. Lorensen and H. Cline, SIGGRAPH 1987): closed where the surface was seen from
	 *  all sides, open where it was not. */
	TriangleMesh mesh() const;

	/** Box of the surface in the object's frame: per axis the 1st to 99th percentile of the voxels just
	 *  below the surface, moved outwards by their mean depth. A voxel counts as often as it was seen
	 *  inside the mask more than outside (8 times at most), so what a mask spilled over once hardly does. Empty without a
	 *  surface. Cheap. */
	std::optional<mrpt::math::TBoundingBox> boundingBox() const;

	/** Trilinear over the known voxels round the point; empty where most of them were not observed. [m] */
	std::optional<double> distance(const mrpt::math::TPoint3D& p_object) const;

	const TsdfOptions& options() const { return options_; }
	std::size_t blockCount() const { return blocks_.size(); }
	bool empty() const { return blocks_.empty(); }
	std::size_t memoryBytes() const;

	/** Version (uint8), options, number of blocks (uint32); a block: index (3 x int16), one bit a voxel
	 *  that holds something (64 bytes), and of those the distances and weights (float), colours (3
	 *  bytes) and evidence (int8). Lossless. */
	void serializeTo(mrpt::serialization::CArchive& out) const;
	/** Throws InputError on unknown versions and damaged content, and leaves the volume as it was. */
	void serializeFrom(mrpt::serialization::CArchive& in);

private:
	/** nullptr when the volume is full or the place is out of reach. */
	TsdfBlock* allocate(const BlockIndex& index);
	/** Drops the blocks without a solid voxel when the volume is full. */
	void makeRoom();
	/** Allocates blocks along the truncation band of every pixelStride-th masked pixel. */
	void allocateBand(
		const mrpt::img::TCamera& camera, const InstanceMask& mask,
		const mrpt::poses::CPose3D& T_object_camera, const DepthMeasurements& measurements,
		int pixelStride);
	void summarize(TsdfBlock& block) const;

	TsdfOptions options_;
	TsdfBlocks blocks_;
};

}  // namespace semloop
