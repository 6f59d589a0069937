#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/object_map/TsdfVolume.h>

#include <map>
#include <random>

#include "AnalyticScene.h"

using namespace semloop;
using namespace semloop::testing;
using Eigen::Vector3d;

namespace
{
Vector3d eigen(const mrpt::math::TPoint3Df& p)
{
	return {p.x, p.y, p.z};
}

/** How often each directed edge is used. */
std::map<std::pair<uint32_t, uint32_t>, int> directedEdges(const TriangleMesh& mesh)
{
	std::map<std::pair<uint32_t, uint32_t>, int> edges;
	for (const auto& t : mesh.triangles)
		for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
	return edges;
}

void expectClosed(const TriangleMesh& mesh)
{
	const auto edges = directedEdges(mesh);
	for (const auto& [edge, count] : edges)
	{
		ASSERT_EQ(count, 1);
		ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
	}
}

/** Divergence theorem; positive when the triangles are counter-clockwise seen from outside. */
double volumeInside(const TriangleMesh& mesh)
{
	double sum = 0;
	for (const auto& t : mesh.triangles)
		sum +=
			eigen(mesh.vertices[t[0]].position)
				.dot(
					eigen(mesh.vertices[t[1]].position).cross(eigen(mesh.vertices[t[2]].position)));
	return sum / 6;
}

/** One block with these distances, as the documented file format has it. */
TsdfVolume blockOf(const std::array<float, 512>& distances)
{
	mrpt::io::CMemoryStream stream;
	auto out = mrpt::serialization::archiveFrom(stream);
	out << uint8_t{0} << 1.0 << 4.0 << 64.0 << int32_t{10} << uint32_t{1};
	for (int i = 0; i < 3; ++i) out << int16_t{0};
	for (int i = 0; i < 64; ++i) out << uint8_t{0xFF};
	out.WriteBufferFixEndianness(distances.data(), distances.size());
	for (int i = 0; i < 512; ++i) out << 1.0F;
	for (int i = 0; i < 512; ++i) out << uint8_t{10} << uint8_t{20} << uint8_t{30} << int8_t{1};
	stream.Seek(0);
	TsdfVolume volume;
	volume.serializeFrom(out);
	return volume;
}
}  // namespace

TEST(TsdfVolumeMesh, ASphereSeenFromAllAroundIsClosed)
{
	constexpr double radius = 0.2, pi = 3.14159265358979;
	TsdfVolume volume(options(0.01));
	for (const auto& pose : posesAllAround(1.0)) fuse(volume, {sphere(radius)}, pose);
	const auto mesh = volume.mesh();
	expectClosed(mesh);
	const double truth = 4.0 / 3 * pi * radius * radius * radius;
	EXPECT_NEAR(volumeInside(mesh), truth, 0.02 * truth);
	// Euler: V - E + F = 2, with 3 F = 2 E.
	EXPECT_EQ(mesh.vertices.size() - mesh.triangles.size() / 2, 2U);
}

TEST(TsdfVolumeMesh, TrianglesAgreeWithTheNormals)
{
	TsdfVolume volume(options(0.01));
	fuse(volume, {sphere(0.2)}, lookAt({1, 0, 0}));
	const auto mesh = volume.mesh();
	ASSERT_GT(mesh.triangles.size(), 1000U);
	int against = 0;
	for (const auto& t : mesh.triangles)
	{
		const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
		const Vector3d facing =
			(eigen(b.position) - eigen(a.position)).cross(eigen(c.position) - eigen(a.position));
		const Vector3d normal(a.normal.x, a.normal.y, a.normal.z);
		against += facing.dot(normal) < 0;
	}
	EXPECT_LT(against, static_cast<int>(mesh.triangles.size()) / 100);
}

TEST(TsdfVolumeMesh, AnOpenSurfaceHasABorderAndNoUnusedVertex)
{
	TsdfVolume volume(options(0.01));
	fuse(volume, {sphere(0.2)}, lookAt({1, 0, 0}));
	const auto mesh = volume.mesh();
	std::vector<int> used(mesh.vertices.size());
	for (const auto& t : mesh.triangles)
		for (const uint32_t v : t)
		{
			ASSERT_LT(v, used.size());
			++used[v];
		}
	EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
	int border = 0;
	const auto edges = directedEdges(mesh);
	for (const auto& [edge, count] : edges)
	{
		EXPECT_EQ(count, 1);
		border += edges.count({edge.second, edge.first}) == 0;
	}
	EXPECT_GT(border, 50);
}

TEST(TsdfVolumeMesh, RandomSignsGiveAClosedMesh)
{
	// 343 cells a block: 40 blocks meet every case of the table, ambiguous faces included.
	std::mt19937 random(5);
	for (int n = 0; n < 40; ++n)
	{
		std::array<float, 512> distances;
		for (int v = 0; v < 512; ++v)
		{
			const int x = v % 8, y = v / 8 % 8, z = v / 64;
			const bool rim = x % 7 == 0 || y % 7 == 0 || z % 7 == 0;
			const float size = 0.1F + static_cast<float>(random() % 1000) / 1000.F;
			distances[v] = rim || random() % 2 ? size : -size;
		}
		const auto mesh = blockOf(distances).mesh();
		ASSERT_GT(mesh.triangles.size(), 200U);
		expectClosed(mesh);
		EXPECT_GT(volumeInside(mesh), 0);
	}
}

TEST(TsdfVolumeMesh, ASingleVoxelGivesAnOctahedron)
{
	std::array<float, 512> distances;
	distances.fill(1);
	distances[TsdfBlock::voxel(3, 4, 5)] = -1;
	const auto mesh = blockOf(distances).mesh();
	EXPECT_EQ(mesh.vertices.size(), 6U);
	EXPECT_EQ(mesh.triangles.size(), 8U);
	expectClosed(mesh);
	// Vertices half a voxel from the centre: volume 4/3 (1/2)^3.
	EXPECT_NEAR(volumeInside(mesh), 1.0 / 6, 1e-5);
	for (const auto& v : mesh.vertices)
	{
		EXPECT_NEAR((eigen(v.position) - Vector3d(3.5, 4.5, 5.5)).norm(), 0.5, 1e-6);
		EXPECT_EQ(v.color.R, 10);
		EXPECT_EQ(v.color.B, 30);
	}
}

TEST(TsdfVolumeMesh, TwoVoxelsThatTouchAtAnEdgeStayApart)
{
	std::array<float, 512> distances;
	distances.fill(1);
	distances[TsdfBlock::voxel(3, 3, 3)] = -1;
	distances[TsdfBlock::voxel(4, 4, 3)] = -1;
	const auto mesh = blockOf(distances).mesh();
	EXPECT_EQ(mesh.vertices.size(), 12U);
	EXPECT_EQ(mesh.triangles.size(), 16U);
	expectClosed(mesh);
}
