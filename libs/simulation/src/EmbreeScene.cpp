#include "EmbreeScene.h"

#include <Eigen/Geometry>

namespace semloop
{
namespace
{
Eigen::Isometry3f isometry(const mrpt::poses::CPose3D& pose)
{
	Eigen::Isometry3f result = Eigen::Isometry3f::Identity();
	result.matrix() = pose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>()
						  .asEigen()
						  .cast<float>();
	return result;
}

RTCGeometry newGeometry(
	RTCDevice device, const Mesh& mesh, const std::vector<Eigen::Vector3f>& corners)
{
	RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
	auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
		geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
		corners.size()));
	for (const auto& corner : corners)
		for (int axis = 0; axis < 3; ++axis) *vertices++ = corner[axis];
	auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
		geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
		mesh.triangles.size()));
	for (const auto& triangle : mesh.triangles)
		for (const uint32_t vertex : triangle.vertices) *indices++ = vertex;
	rtcCommitGeometry(geometry);
	return geometry;
}
}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene)
	: device_(rtcNewDevice("threads=1,set_affinity=0")), all_(rtcNewScene(device_))
{
	add(scene.rooms, mrpt::poses::CPose3D());
	for (const auto& object : scene.objects) add(*object.mesh, object.T_world_object);
	rtcCommitScene(all_);
}

EmbreeScene::~EmbreeScene()
{
	for (const auto& scene : single_) rtcReleaseScene(scene);
	rtcReleaseScene(all_);
	rtcReleaseDevice(device_);
}

void EmbreeScene::add(const Mesh& mesh, const mrpt::poses::CPose3D& T_world_mesh)
{
	const Eigen::Isometry3f T = isometry(T_world_mesh);
	std::vector<Eigen::Vector3f> corners;
	corners.reserve(mesh.vertices.size());
	for (const auto& vertex : mesh.vertices) corners.push_back(T * vertex);

	RTCGeometry geometry = newGeometry(device_, mesh, corners);
	const auto id = static_cast<unsigned>(meshes_.size());
	rtcAttachGeometryByID(all_, geometry, id);
	RTCScene alone = rtcNewScene(device_);
	rtcAttachGeometryByID(alone, geometry, id);
	rtcCommitScene(alone);
	rtcReleaseGeometry(geometry);

	single_.push_back(alone);
	meshes_.push_back(&mesh);
	corners_.push_back(std::move(corners));
}

}  // namespace semloop
