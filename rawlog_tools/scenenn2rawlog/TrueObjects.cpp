#include "TrueObjects.h"

#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <regex>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;

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

/** Makes the folder and removes the meshes of a run before this one; what else is in it stays. */
void prepareFolder(const fs::path& folder)
{
	std::error_code error;
	fs::create_directories(folder, error);
	if (error) throw InputError(folder.string() + ": cannot be made (" + error.message() + ")");
	const std::regex name("[0-9]+_.*\\.ply");
	std::vector<fs::path> meshes;
	for (const auto& entry : fs::directory_iterator(folder))
		if (std::regex_match(entry.path().filename().string(), name))
			meshes.push_back(entry.path());
	for (const auto& mesh : meshes) fs::remove(mesh);
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
	const fs::path folder = prefix + "_objects";
	prepareFolder(folder);
	auto surfaces = surfacesOf(mesh);
	for (std::size_t i = 0; i < surfaces.size(); i++)
		if (const TriangleMesh surface = surfaces[i].finish(); !surface.triangles.empty())
			savePly(
				(folder / objectFileName(mesh.objects[i].id, mesh.objects[i].name)).string(),
				surface, {});
	graph.save(prefix + "_objects.json");
}

}  // namespace semloop
