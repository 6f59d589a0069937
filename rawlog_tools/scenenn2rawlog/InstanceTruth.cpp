#include "InstanceTruth.h"

#include <opencv2/core.hpp>
#include <set>

namespace semloop
{
namespace
{
// Beside the indices of objects.
constexpr int kNoObject = AnnotatedMesh::kNone;
constexpr int kOffMesh = -2;
constexpr int kNoDepth = -3;

LabelSet labelsOf(const AnnotatedMesh& mesh)
{
	std::set<std::string> names;
	for (const auto& object : mesh.objects) names.insert(object.name);
	return LabelSet({names.begin(), names.end()});
}
}  // namespace

InstanceTruth::InstanceTruth(AnnotatedMesh mesh, double tolerance)
	: mesh_(std::move(mesh)),
	  squaredTolerance_(float(tolerance * tolerance)),
	  labels_(labelsOf(mesh_)),
	  observations_(mesh_.objects.size())
{
	vertices_.reserve(mesh_.surface.vertices.size());
	for (const auto& p : mesh_.surface.vertices)
		vertices_.insertPointFast(float(p.x()), float(p.y()), float(p.z()));
	vertices_.mark_as_modified();
	vertices_.kdTreeEnsureIndexBuilt3D();
	for (const auto& object : mesh_.objects)
		labelOfObject_.push_back(uint32_t(labels_.find(object.name).value()));
}

cv::Mat InstanceTruth::objectsOf(
	const mrpt::obs::CObservation3DRangeScan& scan,
	const mrpt::poses::CPose3D& T_world_camera) const
{
	const auto& depth = scan.rangeImage;
	const auto& camera = scan.cameraParams;
	cv::Mat objects(int(depth.rows()), int(depth.cols()), CV_32SC1, cv::Scalar(kNoDepth));
	const auto lookUpRows = [&](const cv::Range& rows)
	{
		for (int v = rows.start; v < rows.end; ++v)
			for (int u = 0; u < objects.cols; ++u)
			{
				if (depth(v, u) == 0) continue;
				const double z = depth(v, u) * double(scan.rangeUnits);
				const auto p = T_world_camera.composePoint(mrpt::math::TPoint3D(
					z * (u - camera.cx()) / camera.fx(), z * (v - camera.cy()) / camera.fy(), z));
				float squaredDistance = 0;
				const std::size_t nearest = vertices_.kdTreeClosestPoint3D(
					float(p.x), float(p.y), float(p.z), squaredDistance);
				objects.at<int>(v, u) =
					squaredDistance <= squaredTolerance_ ? mesh_.objectOfVertex[nearest] : kOffMesh;
			}
	};
	cv::parallel_for_(cv::Range(0, objects.rows), lookUpRows);
	return objects;
}

CObservationInstances InstanceTruth::of(
	const mrpt::obs::CObservation3DRangeScan& scan, const mrpt::poses::CPose3D& T_world_camera)
{
	const cv::Mat objects = objectsOf(scan, T_world_camera);
	std::set<int> seen;
	for (const int object : cv::Mat_<int>(objects))
	{
		validPixels_ += object != kNoDepth;
		pixelsOnMesh_ += object >= kNoObject;
		if (object >= 0) seen.insert(object);
	}

	CObservationInstances observation;
	observation.timestamp = scan.timestamp;
	observation.sensorLabel = "INSTANCES";
	observation.sensorPose = scan.sensorPose;
	observation.camera = scan.cameraParams;
	observation.labels = labels_;
	for (const int object : seen)
	{
		Instance instance;
		instance.mask = InstanceMask::encode(objects == object);
		instance.box = instance.mask.boundingBox();
		instance.labelScores = {{labelOfObject_[object], 1.0F}};
		instance.confidence = 1.0F;
		instance.trueObject = mesh_.objects[object].id;
		observation.instances.push_back(std::move(instance));
		++observations_[object];
	}
	return observation;
}

double InstanceTruth::shareOnMesh() const
{
	return validPixels_ == 0 ? 0.0 : double(pixelsOnMesh_) / double(validPixels_);
}

}  // namespace semloop
