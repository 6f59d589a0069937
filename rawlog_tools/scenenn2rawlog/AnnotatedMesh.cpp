#include "AnnotatedMesh.h"

#include <semloop/config/Error.h>

#include <set>

#include "SceneNnWorld.h"
#include "VertexLabels.h"

namespace semloop
{
namespace
{
Surface readSurface(const std::string& path)
{
	Surface surface = readPly(path);
	if (surface.vertices.empty())
		throw InputError(path + ": has no vertices; give the annotated mesh of this sequence");
	const Eigen::Matrix3d turn = worldFromSceneNn().getRotationMatrix().asEigen();
	for (auto& vertex : surface.vertices)
	{
		if (!vertex.allFinite())
			throw InputError(
				path + ": a vertex is not finite; give the annotated mesh of this sequence");
		vertex = turn * vertex;
	}
	return surface;
}
}  // namespace

AnnotatedMesh readAnnotatedMesh(
	const std::string& meshPath, const SceneNnAnnotation& annotation,
	const std::string& annotationPath)
{
	const auto labels = readVertexLabels(meshPath);
	const std::set<uint32_t> present(labels.begin(), labels.end());
	AnnotatedMesh mesh;
	mesh.surface = readSurface(meshPath);
	std::map<uint32_t, int> indexOf;
	for (const auto& [id, name] : annotation)
	{
		if (present.count(id) == 0) continue;
		indexOf[id] = int(mesh.objects.size());
		mesh.objects.push_back({id, name});
	}
	if (mesh.objects.empty())
		throw InputError(
			annotationPath + ": none of its " + std::to_string(annotation.size()) +
			" named labels is in " + meshPath + "; give annotation and mesh of one sequence");
	mesh.missing = annotation.size() - mesh.objects.size();
	for (const uint32_t label : labels)
	{
		const auto found = indexOf.find(label);
		mesh.objectOfVertex.push_back(
			found == indexOf.end() ? AnnotatedMesh::kNone : found->second);
	}
	return mesh;
}

}  // namespace semloop
