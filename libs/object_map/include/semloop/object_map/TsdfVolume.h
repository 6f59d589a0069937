#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/img/TColor.h>
#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/observations/InstanceMask.h>
#include <semloop/observations/RgbdFrame.h>

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace semloop
{
struct SurfacePoint
{
	mrpt::math::TPoint3Df position;  //!< in the object's frame [m]
	mrpt::math::TVector3Df normal;  //!< unit length, pointing out of the object
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
	cv::Rect box;  //!< part of the image that was cast, in pixels
	int stride = 1;  //!< every stride-th pixel was cast
	cv::Mat depth;  //!< CV_32FC1, one entry per cast pixel [m], 0 = no surface
};

/** How one object is sampled. */
struct TsdfOptions
{
	double voxelSize = 0.01;  //!< [m]
	double truncation = 0.04;  //!< half width of the band round the surface [m]
	double maxWeight = 64;  //!< of the running average, so that a moved surface is overwritten in time
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
	explicit TsdfVolume(const TsdfOptions& options = {});

	/** Fuses the masked pixels of a rectified frame, and carves: a voxel of the object's box that
	 *  projects in front of the measured depth (in the mask or not) is free. Grows as needed. Pixels
	 *  at the mask's depth edges and beyond maxDepth are the caller's business. */
	void integrate(
		const RgbdFrame& frame, const InstanceMask& mask, const mrpt::poses::CPose3D& T_object_camera);

	/** Fuses another volume's surface that lies at T_this_other (resampled trilinearly, weights added). */
	void merge(const TsdfVolume& other, const mrpt::poses::CPose3D& T_this_other);

	/** Casts rays through the pixels where the volume may be seen, at most maxSamples a side (the
	 *  stride follows from that); empty when nothing is hit. */
	std::optional<ObjectPrediction> raycast(
		const mrpt::img::TCamera& camera, const mrpt::poses::CPose3D& T_camera_object,
		int maxSamples = 64) const;

	/** Zero crossings on the voxel edges, with normals from the gradient, in a fixed order. */
	std::vector<SurfacePoint> surface() const;
	/** Marching cubes (W. Lorensen and H. Cline, SIGGRAPH 1987). */
	TriangleMesh mesh() const;

	/** Box of the surface in the object's frame, from robust percentiles; empty without a surface. */
	std::optional<mrpt::math::TBoundingBox> boundingBox() const;

	/** Trilinear; empty where nothing was observed. [m] */
	std::optional<double> distance(const mrpt::math::TPoint3D& p_object) const;

	const TsdfOptions& options() const { return options_; }
	std::size_t blockCount() const;
	bool empty() const { return blockCount() == 0; }
	std::size_t memoryBytes() const;

	void serializeTo(mrpt::serialization::CArchive& out) const;
	void serializeFrom(mrpt::serialization::CArchive& in);

   private:
	TsdfOptions options_;
	// owner of this library: block storage goes here
};

}  // namespace semloop
