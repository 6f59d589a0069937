#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/system/filesystem.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/ObjectFiles.h>
#include <semloop/object_map/SemanticGraph.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <vector>

namespace semloop
{
namespace
{
[[noreturn]] void cannotWrite(const std::string& path)
{
	throw InputError(path + ": cannot be written: check that its folder exists and has room");
}

template <class Number>
void append(std::string& bytes, Number value)
{
	static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the PLY header says little endian");
	char raw[sizeof(Number)];
	std::memcpy(raw, &value, sizeof(Number));
	bytes.append(raw, sizeof(Number));
}

}  // namespace

void saveObjectMap(const std::string& path, const CObjectMap& map)
{
	mrpt::io::CFileGZOutputStream file;
	if (!file.open(path, 3)) cannotWrite(path);
	try
	{
		auto archive = mrpt::serialization::archiveFrom(file);
		archive << map;
	}
	catch (const std::exception&)
	{
		cannotWrite(path);
	}
}

CObjectMap::Ptr loadObjectMap(const std::string& path)
{
	if (!mrpt::system::fileExists(path))
		throw InputError(path + ": no such file: give the map.objmap of a run");
	mrpt::io::CFileGZInputStream file;
	if (!file.open(path)) throw InputError(path + ": cannot be read: check its permissions");
	mrpt::serialization::CSerializable::Ptr object;
	try
	{
		object = mrpt::serialization::archiveFrom(file).ReadObject();
	}
	catch (const InputError& error)
	{
		throw InputError(path + ": " + error.what());
	}
	catch (const std::exception&)
	{
		throw InputError(path + ": cut short, damaged or not an object map: write it again");
	}
	auto map = std::dynamic_pointer_cast<CObjectMap>(object);
	if (!map)
		throw InputError(
			path + ": holds a " +
			(object ? object->GetRuntimeClass()->className : std::string("null")) +
			", not a semloop::CObjectMap: give the map.objmap of a run");
	return map;
}

std::string objectFileName(ObjectId id, std::string label)
{
	std::replace_if(
		label.begin(), label.end(), [](unsigned char c) { return !std::isalnum(c); }, '-');
	return std::to_string(id) + "_" + label + ".ply";
}

std::string makeObjectsFolder(const std::string& prefix)
{
	namespace fs = std::filesystem;
	std::string folder = prefix + "_objects";
	std::error_code error;
	fs::create_directories(folder, error);
	if (error) cannotWrite(folder);
	const std::regex name("[0-9]+_.*\\.ply");
	std::vector<fs::path> meshes;
	for (const auto& entry : fs::directory_iterator(folder))
		if (std::regex_match(entry.path().filename().string(), name))
			meshes.push_back(entry.path());
	for (const auto& mesh : meshes) fs::remove(mesh);
	return folder;
}

void savePly(
	const std::string& path, const TriangleMesh& mesh, const mrpt::poses::CPose3D& T_world_object)
{
	std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment vertices in metres, world\n";
	bytes += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
	for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
		bytes += std::string("property float ") + name + "\n";
	for (const char* name : {"red", "green", "blue"})
		bytes += std::string("property uchar ") + name + "\n";
	bytes += "element face " + std::to_string(mesh.triangles.size()) + "\n";
	bytes += "property list uchar int vertex_indices\nend_header\n";
	for (const auto& vertex : mesh.vertices)
	{
		const auto p = T_world_object.composePoint(mrpt::math::TPoint3D(vertex.position));
		const auto n = T_world_object.rotateVector(
			mrpt::math::TVector3D(vertex.normal.x, vertex.normal.y, vertex.normal.z));
		for (const double value : {p.x, p.y, p.z, n.x, n.y, n.z}) append(bytes, float(value));
		for (const uint8_t value : {vertex.color.R, vertex.color.G, vertex.color.B})
			append(bytes, value);
	}
	for (const auto& triangle : mesh.triangles)
	{
		append(bytes, uint8_t(3));
		for (const uint32_t index : triangle) append(bytes, int32_t(index));
	}
	std::ofstream file(path, std::ios::binary);
	file.write(bytes.data(), std::streamsize(bytes.size()));
	file.close();
	if (!file) cannotWrite(path);
}

void CObjectMap::saveMetricMapRepresentationToFile(const std::string& filePrefix) const
{
	mrpt::opengl::COpenGLScene scene;
	auto all = mrpt::opengl::CSetOfObjects::Create();
	getVisualizationInto(*all);
	scene.insert(all);
	if (!scene.saveToFile(filePrefix + ".3Dscene")) cannotWrite(filePrefix + ".3Dscene");
	saveObjectMap(filePrefix + ".objmap", *this);
	SemanticGraph::fromMap(*this).save(filePrefix + ".json");

	const std::string folder = makeObjectsFolder(filePrefix);
	for (const auto& [id, object] : objects_)
		savePly(
			folder + "/" + objectFileName(id, labelName(object)), object.volume->mesh(),
			object.T_world_object);
}

}  // namespace semloop
