#pragma once

#include <embree3/rtcore.h>
#include <semloop/simulation/Scene.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace semloop
{
/** The scene's triangles in the world, in Embree's hands: geometry ids are SceneObject::id, 0 the rooms. */
class EmbreeScene
{
public:
	explicit EmbreeScene(const Scene& scene);
	~EmbreeScene();
	EmbreeScene(const EmbreeScene&) = delete;
	EmbreeScene& operator=(const EmbreeScene&) = delete;

	RTCScene all() const { return all_; }
	/** One object alone. */
	RTCScene only(uint32_t object) const { return single_[object]; }
	const Mesh& mesh(uint32_t object) const { return *meshes_[object]; }
	/** Its corners in the world. */
	const std::vector<Eigen::Vector3f>& corners(uint32_t object) const { return corners_[object]; }
	std::size_t size() const { return meshes_.size(); }

private:
	void add(const Mesh& mesh, const mrpt::poses::CPose3D& T_world_mesh);

	RTCDevice device_;
	RTCScene all_;
	std::vector<RTCScene> single_;
	std::vector<const Mesh*> meshes_;
	std::vector<std::vector<Eigen::Vector3f>> corners_;
};

constexpr unsigned kPacket = 16;

/** Rays from one point, as Embree takes them. */
template <class Packet>
void setRay(
	Packet& rays, unsigned i, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction)
{
	rays.org_x[i] = origin.x();
	rays.org_y[i] = origin.y();
	rays.org_z[i] = origin.z();
	rays.dir_x[i] = direction.x();
	rays.dir_y[i] = direction.y();
	rays.dir_z[i] = direction.z();
	rays.time[i] = 0.0F;
	rays.mask[i] = ~0U;
	rays.id[i] = i;
	rays.flags[i] = 0;
}

}  // namespace semloop
