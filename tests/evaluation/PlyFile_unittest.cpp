#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/PlyFile.h>
#include <semloop/object_map/ObjectFiles.h>

#include "TemporaryFolder.h"

namespace semloop
{
namespace
{
using ::testing::HasSubstr;
using Triangle = std::array<uint32_t, 3>;

const std::string kHeader =
	"ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty double x\n"
	"property uchar red\nproperty double y\nproperty double z\nelement face 1\n"
	"property list uchar int vertex_indices\nend_header\n";
const std::string kSquare = kHeader + "0 255 0 0\n1 255 0 0\n1 255 1 0.5\n0 255 1 0\n4 0 1 2 3\n";

TEST(PlyFile, ReadsTextAndCutsAFaceIntoTriangles)
{
	const TemporaryFolder folder;
	const auto surface = readPly(folder.write("a.ply", kSquare));
	ASSERT_EQ(surface.vertices.size(), 4u);
	EXPECT_EQ(surface.vertices[2], Eigen::Vector3d(1, 1, 0.5));
	EXPECT_EQ(surface.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
	EXPECT_TRUE(surface.labels.empty());
}

TEST(PlyFile, ReadsTheLabelsOfTheVertices)
{
	const TemporaryFolder folder;
	const auto surface = readPly(folder.write(
		"a.ply",
		"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty uint label\n"
		"property float y\nproperty float z\nend_header\n1 4294967295 2 3\n4 17 5 6\n"));
	EXPECT_EQ(surface.labels, (std::vector<double>{4294967295, 17}));
	EXPECT_EQ(surface.vertices[1], Eigen::Vector3d(4, 5, 6));
}

TEST(PlyFile, ReadsWhatAnObjectMapWrites)
{
	const TemporaryFolder folder;
	TriangleMesh mesh;
	mesh.vertices.resize(3);
	mesh.vertices[0].position = {1, 2, 3};
	mesh.vertices[2].position = {-1, 0, 0.5f};
	mesh.triangles = {{2, 1, 0}};
	savePly(folder.file("a.ply"), mesh, mrpt::poses::CPose3D(10, 0, 0, 0, 0, 0));
	const auto surface = readPly(folder.file("a.ply"));
	ASSERT_EQ(surface.vertices.size(), 3u);
	EXPECT_EQ(surface.vertices[0], Eigen::Vector3d(11, 2, 3));
	EXPECT_EQ(surface.vertices[2], Eigen::Vector3d(9, 0, 0.5));
	EXPECT_EQ(surface.triangles, (std::vector<Triangle>{{2, 1, 0}}));
}

TEST(PlyFile, ErrorsNameTheFileAndWhatIsWrong)
{
	const TemporaryFolder folder;
	const auto errorOf = [&](const std::string& text)
	{ return messageOf<InputError>([&] { readPly(folder.write("a.ply", text)); }); };
	EXPECT_THAT(
		messageOf<InputError>([&] { readPly(folder.file("none.ply")); }),
		HasSubstr("none.ply: cannot be read"));
	EXPECT_THAT(errorOf("solid\n"), HasSubstr("a.ply: not a PLY file"));
	EXPECT_THAT(errorOf("ply\nformat ascii 1.0\n"), HasSubstr("no end"));
	EXPECT_THAT(
		errorOf("ply\nformat binary_big_endian 1.0\nend_header\n"), HasSubstr("big_endian"));
	EXPECT_THAT(errorOf("ply\nproperty float x\nend_header\n"), HasSubstr("before any element"));
	EXPECT_THAT(errorOf(kSquare.substr(0, kSquare.size() - 4)), HasSubstr("ends early"));
	EXPECT_THAT(
		errorOf(kHeader + "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 3 0 1 4\n"), HasSubstr("not there"));
}
}  // namespace
}  // namespace semloop
