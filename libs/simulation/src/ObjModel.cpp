#include "ObjModel.h"

#include <semloop/config/Error.h>
#include <tiny_obj_loader.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include "ObjMaterials.h"

namespace semloop
{
namespace
{
//! Twice the area over the square of the longest side.
constexpr float kThinnest = 1e-6F;

/** Gives the OBJ reader the .mtl files beside the model in the archive. */
class ArchivedMaterials : public tinyobj::MaterialReader
{
public:
	ArchivedMaterials(const ZipArchive& archive, std::filesystem::path folder)
		: archive_(archive), folder_(std::move(folder))
	{
	}

	bool operator()(
		const std::string& file, std::vector<tinyobj::material_t>* materials,
		std::map<std::string, int>* byName, std::string* warning, std::string* error) override
	{
		const std::string path = (folder_ / file).generic_string();
		if (!archive_.contains(path)) return false;
		std::istringstream in(archive_.read(path));
		tinyobj::LoadMtl(byName, materials, &in, warning, error);
		return true;
	}

private:
	const ZipArchive& archive_;
	std::filesystem::path folder_;
};

struct ObjFile
{
	tinyobj::attrib_t attributes;
	std::vector<tinyobj::shape_t> shapes;
	std::vector<tinyobj::material_t> materials;
};

ObjFile parse(const ZipArchive& archive, const std::string& path)
{
	ObjFile file;
	std::string warning, error;
	std::istringstream in(archive.read(path));
	ArchivedMaterials materials(archive, std::filesystem::path(path).parent_path());
	const bool read = tinyobj::LoadObj(
		&file.attributes, &file.shapes, &file.materials, &warning, &error, &in, &materials,
		true /* triangulate */);
	// A missing .mtl is an error for the reader too, but only the colours are lost.
	if (!read)
		throw InputError(
			archive.path() + ": " + path +
			": not an OBJ model: " + error.substr(0, error.find('\n')));
	return file;
}

/** The n-th of an array of N numbers each; none when there are not so many. */
template <int N>
bool get(const std::vector<float>& numbers, int n, Eigen::Matrix<float, N, 1>& out)
{
	if (n < 0 || (static_cast<std::size_t>(n) + 1) * N > numbers.size()) return false;
	out = Eigen::Map<const Eigen::Matrix<float, N, 1>>(numbers.data() + n * std::size_t{N});
	return out.allFinite();
}

/** Finite, and of three different vertices that are not on one line. */
bool hasArea(const std::array<Eigen::Vector3f, 3>& p)
{
	const Eigen::Vector3f a = p[1] - p[0], b = p[2] - p[0], c = p[2] - p[1];
	const float longest = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
	return a.cross(b).norm() > kThinnest * longest;
}

/** Appends triangles; shares the vertices of one OBJ index, leaves out those that nobody uses. */
class TriangleCollector
{
public:
	TriangleCollector(const tinyobj::attrib_t& attributes, Mesh& mesh)
		: attributes_(attributes), mesh_(mesh), numbers_(attributes.vertices.size() / 3, kUnused)
	{
	}

	void add(const tinyobj::index_t* corners, uint32_t material)
	{
		std::array<Eigen::Vector3f, 3> points;
		for (std::size_t i = 0; i < 3; i++)
			if (!get(attributes_.vertices, corners[i].vertex_index, points[i])) return;
		if (!hasArea(points)) return;

		Mesh::Triangle triangle;
		triangle.material = material;
		for (std::size_t i = 0; i < 3; i++)
		{
			uint32_t& number = numbers_[static_cast<std::size_t>(corners[i].vertex_index)];
			if (number == kUnused)
			{
				number = static_cast<uint32_t>(mesh_.vertices.size());
				mesh_.vertices.push_back(points[i]);
			}
			triangle.vertices[i] = number;
			if (!get(attributes_.texcoords, corners[i].texcoord_index, triangle.uv[i]))
				triangle.uv[i].setZero();
		}
		mesh_.triangles.push_back(triangle);
	}

private:
	static constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();

	const tinyobj::attrib_t& attributes_;
	Mesh& mesh_;
	std::vector<uint32_t> numbers_;
};

}  // namespace

ObjModel readObj(const ZipArchive& archive, const std::string& path)
{
	const ObjFile file = parse(archive, path);
	ObjModel model;
	addMaterials(model, file.materials, archive, path);
	const auto grey = static_cast<uint32_t>(model.mesh.materials.size());
	model.mesh.materials.emplace_back();
	model.opacity.push_back(1);

	TriangleCollector collector(file.attributes, model.mesh);
	for (const tinyobj::shape_t& shape : file.shapes)
		for (std::size_t i = 0; 3 * i + 2 < shape.mesh.indices.size(); i++)
		{
			const int id = shape.mesh.material_ids.at(i);
			const bool known = id >= 0 && static_cast<uint32_t>(id) < grey;
			collector.add(&shape.mesh.indices[3 * i], known ? static_cast<uint32_t>(id) : grey);
		}
	if (model.mesh.triangles.empty())
		throw InputError(archive.path() + ": " + path + ": not an OBJ model: it has no triangles");
	return model;
}

}  // namespace semloop
