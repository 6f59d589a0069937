#include "TrueObjects.h"

#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>

#include <Eigen/Geometry>
#include <map>

namespace semloop
{
namespace
{
using Boxes = std::vector<Eigen::AlignedBox3d>;

Boxes boxesOf(const AnnotatedMesh& mesh)
{
	Boxes boxes(mesh.objects.size());
	for (std::size_t i = 0; i < mesh.objectOfVertex.size(); i++)
		if (const int object = mesh.objectOfVertex[i]; object != AnnotatedMesh::kNone)
			boxes[object].extend(mesh.surface.vertices[i]);
	return boxes;
}

/** Gathers the triangles of one object; normals are the mean over a vertex' triangles, by area. */
class ObjectSurface
{
public:
	void add(const Surface& surface, const std::array<uint32_t, 3>& triangle)
	{
		const auto corner = [&](int i) -> const auto&
		{
			return surface.vertices[triangle[i]];
		};
		const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
		auto& added = mesh_.triangles.emplace_back();
		for (int i = 0; i < 3; i++)
		{
			added[i] = indexOf(triangle[i], corner(i));
			normals_[added[i]] += normal;
		}
	}

	TriangleMesh finish()
	{
		for (std::size_t i = 0; i < normals_.size(); i++)
		{
			const Eigen::Vector3f n = normals_[i].normalized().cast<float>();
			mesh_.vertices[i].normal = {n.x(), n.y(), n.z()};
		}
		return std::move(mesh_);
	}

private:
	uint32_t indexOf(uint32_t vertex, const Eigen::Vector3d& p)
	{
		const auto [place, isNew] = indices_.emplace(vertex, uint32_t(indices_.size()));
		if (isNew)
		{
			SurfacePoint point;
			point.position = {float(p.x()), float(p.y()), float(p.z())};
			mesh_.vertices.push_back(point);
			normals_.emplace_back(Eigen::Vector3d::Zero());
		}
		return place->second;
	}

	TriangleMesh mesh_;
	std::vector<Eigen::Vector3d> normals_;
	std::map<uint32_t, uint32_t> indices_;  //!< by vertex of the whole mesh
};

std::vector<ObjectSurface> surfacesOf(const AnnotatedMesh& mesh)
{
	std::vector<ObjectSurface> surfaces(mesh.objects.size());
	for (const auto& triangle : mesh.surface.triangles)
	{
		const int object = mesh.objectOfVertex[triangle[0]];
		if (object != AnnotatedMesh::kNone && object == mesh.objectOfVertex[triangle[1]] &&
			object == mesh.objectOfVertex[triangle[2]])
			surfaces[object].add(mesh.surface, triangle);
	}
	return surfaces;
}

}  // namespace

void writeTrueObjects(
	const std::string& prefix, const AnnotatedMesh& mesh, const std::vector<int>& observations)
{
	const Boxes boxes = boxesOf(mesh);
	SemanticGraph graph;
	for (std::size_t i = 0; i < mesh.objects.size(); i++)
	{
		const Eigen::Vector3d centre = boxes[i].center(), size = boxes[i].sizes();
		GraphVertex vertex;
		vertex.id = mesh.objects[i].id;
		vertex.label = mesh.objects[i].name;
		vertex.position = {centre.x(), centre.y(), centre.z()};
		vertex.extent = mrpt::math::TVector3D(size.x(), size.y(), size.z());
		vertex.observations = observations[i];
		graph.vertices.push_back(vertex);
	}
	const std::string folder = makeObjectsFolder(prefix);
	auto surfaces = surfacesOf(mesh);
	for (std::size_t i = 0; i < surfaces.size(); i++)
		if (const TriangleMesh surface = surfaces[i].finish(); !surface.triangles.empty())
			savePly(
				folder + "/" + objectFileName(mesh.objects[i].id, mesh.objects[i].name), surface,
				{});
	graph.save(prefix + "_objects.json");
}

}  // namespace semloop
