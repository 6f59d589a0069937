#include <semloop/config/Error.h>
#include <semloop/simulation/FurnitureCatalog.h>

#include <algorithm>
#include <limits>

#include "ObjMaterials.h"
#include "ObjModel.h"
#include "ZipArchive.h"

namespace semloop
{
namespace
{
constexpr float kGlass = 0.15F;  //!< opacity below which a depth sensor sees through
constexpr int kLargestTexture = 512;
constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

/** From the OBJ's axes (x right, y up, z to the viewer) to furniture's (x right, y to the back, z up),
 *  and each axis scaled until the box has the catalogue's size. A flat model stays flat. */
void fitIntoBox(Mesh& mesh, const CatalogEntry& entry)
{
	Eigen::Matrix3d fromObj;
	fromObj << 1, 0, 0, 0, 0, -1, 0, 1, 0;
	const Eigen::Matrix3f turn = (fromObj * entry.modelRotation).cast<float>();
	for (Eigen::Vector3f& vertex : mesh.vertices) vertex = turn * vertex;

	const Bounds box = boundsOf(mesh);
	const Eigen::Vector3f extent = box.size();
	const float flat = 1e-6F * extent.maxCoeff();
	const Eigen::Vector3f size = entry.size.cast<float>();
	const Eigen::Vector3f scale =
		(extent.array() > flat)
			.select(size.array() / extent.array().max(std::numeric_limits<float>::min()), 1.0F);
	Eigen::Vector3f origin = 0.5F * (box.minimum + box.maximum);
	origin.z() = box.minimum.z();
	for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (vertex - origin).cwiseProduct(scale);
}

/** Moves what is used to the front of an array and cuts the rest. `numbers`: old to new index. */
template <typename Value>
void keepUsed(std::vector<Value>& values, std::vector<uint32_t>& numbers)
{
	uint32_t kept = 0;
	for (std::size_t i = 0; i < values.size(); i++)
		if (numbers[i] != kUnused)
		{
			numbers[i] = kept;
			values[kept++] = values[i];
		}
	values.resize(kept);
}

void dropGlass(ObjModel& model)
{
	Mesh& mesh = model.mesh;
	const auto isGlass = [&](const Mesh::Triangle& t)
	{ return model.opacity[t.material] < kGlass; };
	mesh.triangles.erase(
		std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), isGlass),
		mesh.triangles.end());

	std::vector<uint32_t> vertices(mesh.vertices.size(), kUnused);
	std::vector<uint32_t> materials(mesh.materials.size(), kUnused);
	for (const Mesh::Triangle& triangle : mesh.triangles)
	{
		for (const uint32_t vertex : triangle.vertices) vertices[vertex] = 0;
		materials[triangle.material] = 0;
	}
	keepUsed(mesh.vertices, vertices);
	keepUsed(mesh.materials, materials);
	for (Mesh::Triangle& triangle : mesh.triangles)
	{
		for (uint32_t& vertex : triangle.vertices) vertex = vertices[vertex];
		triangle.material = materials[triangle.material];
	}
	model.opacity.clear();
}

/** Reads the textures that materials use. What cannot be decoded leaves the plain colour; otherwise the
 *  texture alone counts, since exporters write any Kd beside it, even black. */
void readTextures(ObjModel& model, const ZipArchive& archive)
{
	std::vector<int> loaded(model.texturePaths.size(), -2);
	for (Material& material : model.mesh.materials)
	{
		if (material.texture < 0) continue;
		const auto path = static_cast<std::size_t>(material.texture);
		if (loaded[path] == -2)
		{
			const auto image =
				decodeTexture(archive.read(model.texturePaths[path]), kLargestTexture);
			loaded[path] = image ? static_cast<int>(model.mesh.textures.size()) : -1;
			if (image) model.mesh.textures.push_back(*image);
		}
		material.texture = loaded[path];
		if (material.texture >= 0) material.color = {1, 1, 1};
	}
}

}  // namespace

Mesh FurnitureCatalog::load(const CatalogEntry& entry) const
{
	const ZipArchive archive(entry.archive);
	ObjModel model = readObj(archive, entry.model);
	fitIntoBox(model.mesh, entry);
	dropGlass(model);
	if (model.mesh.triangles.empty())
		throw InputError(entry.archive + ": " + entry.model + ": all of it is transparent");
	readTextures(model, archive);
	return std::move(model.mesh);
}

}  // namespace semloop
