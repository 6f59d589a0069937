#include "KeyFrameObservations.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/ExternalImages.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

namespace semloop
{
namespace
{
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::poses::CPose3D;

constexpr double kMostPoints = 20000;
/** A tilted camera's columns do not fall on one direction each: some more leave no gaps. */
constexpr double kRaysPerColumn = 1.2;

/** So that a file with it can be moved without the rawlog's folder of images. */
CObservation3DRangeScan::Ptr withImagesInside(const CObservation3DRangeScan& original)
{
	const auto scan = CObservation3DRangeScan::Create(original);
	// New points come in their place.
	scan->points3D_overrideExternalStoredFlag(false);
	scan->hasPoints3D = false;
	scan->load();
	scan->rangeImage_forceResetExternalStorage();
	// A loaded image still is an external one: only a new one is written with its pixels.
	if (scan->hasIntensityImage && scan->intensityImage.isExternallyStored())
		scan->intensityImage = mrpt::img::CImage(
			readImageFile(
				scan->intensityImage.getExternalStorageFileAbsolutePath(), cv::IMREAD_UNCHANGED),
			mrpt::img::DEEP_COPY);
	return scan;
}

/** Every step-th pixel of the depth up to maxDepth [m], as points in the sensor's frame. */
CObservation3DRangeScan unprojected(const CObservation3DRangeScan& scan, double maxDepth, int step)
{
	CObservation3DRangeScan result;
	result.cameraParams = scan.cameraParams;
	result.range_is_depth = scan.range_is_depth;
	result.rangeUnits = scan.rangeUnits;
	result.maxRange = float(maxDepth);
	result.hasRangeImage = true;
	result.rangeImage = scan.rangeImage;
	cutDepth(result, maxDepth);
	auto& depth = result.rangeImage;
	for (int v = 0; v < depth.rows(); ++v)
		for (int u = 0; u < depth.cols(); ++u)
			if (v % step != 0 || u % step != 0) depth(v, u) = 0;
	mrpt::obs::T3DPointsProjectionParams params;
	params.takeIntoAccountSensorPoseOnRobot = false;
	// Its own decimation wants sizes that are multiples of it.
	params.decimation = 1;
	result.unprojectInto(result, params);
	return result;
}

/** The place and heading of a pose. */
CPose3D levelled(const CPose3D& pose)
{
	const auto& m = pose.getRotationMatrix();
	return CPose3D(pose.x(), pose.y(), pose.z(), std::atan2(m(1, 0), m(0, 0)), 0, 0);
}

/** Of each direction the nearest point between scanBelow under the camera and scanAbove over it.
 *
 *  CObservation3DRangeScan::convertTo2DScan() does the same, but keeps a table of 24 bytes a pixel for each
 *  pose of the sensor, a hundred of them, and each of these poses is another. */
CObservation2DRangeScan::Ptr horizontalScan(
	const CObservation3DRangeScan& points, const CPose3D& T_level_sensor,
	const SlamOptions& options)
{
	const auto& camera = points.cameraParams;
	const double width = double(camera.ncols);
	const auto scan = CObservation2DRangeScan::Create();
	scan->rightToLeft = true;
	scan->maxRange = points.maxRange;
	scan->aperture = float(2 * std::atan(std::max(camera.cx(), width - camera.cx()) / camera.fx()));
	scan->resizeScan(std::size_t(kRaysPerColumn * width));
	const double step = scan->aperture / double(scan->getScanSize() - 1);
	for (std::size_t i = 0; i < points.points3D_x.size(); ++i)
	{
		const auto p = T_level_sensor.composePoint(
			mrpt::math::TPoint3D(points.points3D_x[i], points.points3D_y[i], points.points3D_z[i]));
		if (p.z < -options.scanBelow || p.z > options.scanAbove) continue;
		const double ray = std::round((std::atan2(p.y, p.x) + scan->aperture / 2) / step);
		if (!(ray >= 0 && ray < double(scan->getScanSize()))) continue;
		const auto index = std::size_t(ray);
		const float range = float(std::hypot(p.x, p.y));
		if (scan->getScanRangeValidity(index) && scan->getScanRange(index) <= range) continue;
		scan->setScanRange(index, range);
		scan->setScanRangeValidity(index, true);
	}
	return scan;
}
}  // namespace

void cutDepth(CObservation3DRangeScan& scan, double maxDepth)
{
	const double limit = maxDepth / scan.rangeUnits;
	for (auto& value : scan.rangeImage)
		if (value > limit) value = 0;
}

KeyFrameObservations keyFrameObservations(const SemanticSlam& slam, const KeyFrame& key)
{
	const auto scan = withImagesInside(*key.scan);
	const auto instances = CObservationInstances::Create(*key.instances);
	const CPose3D T_world_sensor =
		slam.poseGraph().pose(NodeId::camera(key.frame)) + (-sensorFromCamera());
	const CPose3D T_world_robot = T_world_sensor + (-scan->sensorPose);
	KeyFrameObservations result;
	result.T_world_robot = levelled(T_world_robot);
	const CPose3D tilt = (-result.T_world_robot) + T_world_robot;
	scan->sensorPose = tilt + scan->sensorPose;
	instances->sensorPose = tilt + instances->sensorPose;

	const double maxDepth = slam.map().insertionOptions.maxDepth;
	const auto points = unprojected(
		*scan, maxDepth, int(std::ceil(std::sqrt(double(scan->rangeImage.size()) / kMostPoints))));
	scan->hasPoints3D = true;
	scan->points3D_x = points.points3D_x;
	scan->points3D_y = points.points3D_y;
	scan->points3D_z = points.points3D_z;
	scan->points3D_idxs_x = points.points3D_idxs_x;
	scan->points3D_idxs_y = points.points3D_idxs_y;

	const auto all = unprojected(*scan, maxDepth, 1);
	const CPose3D T_world_level = levelled(T_world_sensor);
	const auto horizontal = horizontalScan(all, (-T_world_level) + T_world_sensor, slam.options());
	horizontal->timestamp = scan->timestamp;
	horizontal->sensorLabel = scan->sensorLabel + "_horizontal";
	horizontal->sensorPose = (-result.T_world_robot) + T_world_level;

	result.frame = mrpt::obs::CSensoryFrame::Create();
	result.frame->insert(scan);
	result.frame->insert(horizontal);
	result.frame->insert(instances);
	return result;
}

}  // namespace semloop
