#include "AnnotatedMesh.h"

#include <semloop/config/Error.h>

#include <cmath>
#include <limits>
#include <set>

#include "SceneNnWorld.h"

namespace semloop
{
namespace
{
[[noreturn]] void fail(const std::string& path, const std::string& problem)
{
	throw InputError(path + ": " + problem + "; give the annotated mesh of this sequence");
}

Surface readSurface(const std::string& path)
{
	Surface surface = readPly(path);
	if (surface.vertices.empty()) fail(path, "has no vertices");
	if (surface.labels.empty()) fail(path, "its vertices have no property 'label'");
	const Eigen::Matrix3d turn = worldFromSceneNn().getRotationMatrix().asEigen();
	for (auto& vertex : surface.vertices)
	{
		if (!vertex.allFinite()) fail(path, "a vertex is not finite");
		vertex = turn * vertex;
	}
	return surface;
}

std::vector<uint32_t> idsFrom(const std::vector<double>& labels, const std::string& path)
{
	std::vector<uint32_t> ids;
	ids.reserve(labels.size());
	for (const double label : labels)
	{
		if (!(label >= 0 && label <= std::numeric_limits<uint32_t>::max()) ||
			label != std::floor(label))
			fail(path, "vertex " + std::to_string(ids.size()) + " has a label that is no id");
		ids.push_back(uint32_t(label));
	}
	return ids;
}
}  // namespace

AnnotatedMesh readAnnotatedMesh(
	const std::string& meshPath, const SceneNnAnnotation& annotation,
	const std::string& annotationPath)
{
	AnnotatedMesh mesh;
	mesh.surface = readSurface(meshPath);
	const auto labels = idsFrom(mesh.surface.labels, meshPath);
	const std::set<uint32_t> present(labels.begin(), labels.end());
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
