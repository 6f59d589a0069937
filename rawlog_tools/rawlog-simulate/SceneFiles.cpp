#include "SceneFiles.h"

#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>

#include <fstream>

namespace semloop
{
namespace
{
mrpt::math::TPoint3D toPoint(const Eigen::Vector3f& p)
{
	return {p.x(), p.y(), p.z()};
}

GraphVertex vertexOf(const SceneObject& object, const LabelSet& labels, int observations)
{
	const Bounds bounds = boundsOf(*object.mesh);
	const Eigen::Vector3f size = bounds.size();
	GraphVertex vertex;
	vertex.id = object.id;
	vertex.label = labels.name(object.label);
	vertex.position =
		object.T_world_object.composePoint(toPoint((bounds.minimum + bounds.maximum) / 2.0F));
	vertex.extent = mrpt::math::TVector3D(size.x(), size.y(), size.z());
	mrpt::math::CQuaternionDouble orientation;
	object.T_world_object.getAsQuaternion(orientation);
	vertex.orientation = orientation;
	vertex.observations = observations;
	return vertex;
}

TriangleMesh surfaceOf(const SceneObject& object)
{
	TriangleMesh surface;
	for (const auto& triangle : object.mesh->triangles)
	{
		const auto corner = [&](int i) { return object.mesh->vertices[triangle.vertices[i]]; };
		const Eigen::Vector3f normal =
			(corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
		const auto first = uint32_t(surface.vertices.size());
		for (int i = 0; i < 3; ++i)
		{
			SurfacePoint point;
			point.position = {corner(i).x(), corner(i).y(), corner(i).z()};
			point.normal = {normal.x(), normal.y(), normal.z()};
			surface.vertices.push_back(point);
		}
		surface.triangles.push_back({first, first + 1, first + 2});
	}
	return surface;
}
}  // namespace

void writeTrueObjects(
	const std::string& prefix, const Scene& scene, const std::map<uint32_t, int>& observations)
{
	SemanticGraph graph;
	const std::string folder = makeObjectsFolder(prefix);
	for (const auto& object : scene.objects)
	{
		const auto seen = observations.find(object.id);
		graph.vertices.push_back(
			vertexOf(object, scene.labels, seen == observations.end() ? 0 : seen->second));
		savePly(
			folder + "/" + objectFileName(object.id, scene.labels.name(object.label)),
			surfaceOf(object), object.T_world_object);
	}
	graph.save(prefix + "_objects.json");
}

void writeAttribution(const std::string& path, const Scene& scene, const FurnitureCatalog& catalog)
{
	std::map<std::string, const CatalogEntry*> used;
	for (const auto& object : scene.objects)
		if (const auto entry = catalog.entries().find(object.model);
			entry != catalog.entries().end())
			used[object.model] = &entry->second;
	std::ofstream out(path);
	out << "Models of Debian's package sweethome3d-furniture that this scene shows\n\n";
	for (const auto& [id, entry] : used)
		out << id << ": " << entry->name << ", by " << entry->creator << ". " << entry->license
			<< "\n";
	out << "\nEverything else is semloop's own.\n";
	if (!out.flush()) throw InputError(path + ": cannot be written; is the disk full?");
}

}  // namespace semloop
