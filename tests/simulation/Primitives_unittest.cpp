#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/Primitives.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/core.hpp>

#include "TemporaryFolder.h"

using Eigen::Vector3f;
using semloop::boundsOf;
using semloop::makePrimitive;
using semloop::Mesh;
using semloop::primitiveKinds;

namespace
{
bool same(const Mesh& a, const Mesh& b)
{
	if (a.vertices != b.vertices || a.textures.size() != b.textures.size()) return false;
	for (std::size_t i = 0; i < a.textures.size(); i++)
		if (cv::norm(a.textures[i], b.textures[i], cv::NORM_INF) != 0) return false;
	return true;
}

Vector3f normalOf(const Mesh& mesh, const Mesh::Triangle& triangle)
{
	const auto& [a, b, c] = triangle.vertices;
	return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

/** Largest area of textured triangles that look along an axis. */
float texturedArea(const Mesh& mesh, const Vector3f& axis)
{
	float area = 0;
	for (const auto& triangle : mesh.triangles)
		if (mesh.materials[triangle.material].texture >= 0)
			area = std::max(area, normalOf(mesh, triangle).dot(axis) / 2);
	return area;
}

}  // namespace

TEST(Primitives, StandOnTheFloorWithTheOriginInTheMiddle)
{
	for (const auto& kind : primitiveKinds())
	{
		const auto bounds = boundsOf(makePrimitive(kind, 7));
		EXPECT_NEAR(bounds.minimum.z(), 0, 1e-6) << kind;
		EXPECT_NEAR(bounds.minimum.x(), -bounds.maximum.x(), 1e-6) << kind;
		EXPECT_NEAR(bounds.minimum.y(), -bounds.maximum.y(), 1e-6) << kind;
	}
}

TEST(Primitives, HaveTheSizeOfRealOnes)
{
	const auto expectNear = [](const char* kind, const Vector3f& usual)
	{
		for (uint64_t seed = 0; seed < 20; seed++)
		{
			const Vector3f size = boundsOf(makePrimitive(kind, seed)).size();
			EXPECT_LT((size - usual).cwiseQuotient(usual).cwiseAbs().maxCoeff(), 0.05F) << kind;
		}
	};
	expectNear("keyboard", {0.44F, 0.14F, 0.025F});
	expectNear("monitor", {0.53F, 0.18F, 0.42F});
	expectNear("mouse", {0.06F, 0.10F, 0.035F});
	for (uint64_t seed = 0; seed < 20; seed++)
	{
		const Vector3f book = boundsOf(makePrimitive("book", seed)).size();
		EXPECT_TRUE((book.array() >= Vector3f(0.15F, 0.20F, 0.02F).array() - 1e-6F).all());
		EXPECT_TRUE((book.array() <= Vector3f(0.22F, 0.28F, 0.05F).array() + 1e-6F).all());
	}
}

TEST(Primitives, AreTheSameForTheSameSeedAndDifferForAnother)
{
	for (const auto& kind : primitiveKinds())
	{
		EXPECT_TRUE(same(makePrimitive(kind, 3), makePrimitive(kind, 3))) << kind;
		EXPECT_FALSE(same(makePrimitive(kind, 3), makePrimitive(kind, 4))) << kind;
	}
}

TEST(Primitives, ShowTheirContentWhereOneLooksAtThem)
{
	// two triangles a side: each has a bit under half of it
	EXPECT_GT(texturedArea(makePrimitive("monitor", 1), {0, -1, 0}), 0.4F * 0.53F * 0.3F);
	EXPECT_EQ(texturedArea(makePrimitive("monitor", 1), {0, 1, 0}), 0);
	EXPECT_GT(texturedArea(makePrimitive("picture", 1), {0, -1, 0}), 0.4F * 0.3F * 0.2F);
	EXPECT_GT(texturedArea(makePrimitive("keyboard", 1), {0, 0, 1}), 0.4F * 0.44F * 0.14F);
	EXPECT_GT(texturedArea(makePrimitive("book", 1), {0, 0, 1}), 0.4F * 0.15F * 0.20F);
}

TEST(Primitives, LookOutwardsEverywhere)
{
	for (const char* const kind : {"book", "mouse", "keyboard"})
	{
		const Mesh mesh = makePrimitive(kind, 2);
		const Vector3f middle(0, 0, boundsOf(mesh).maximum.z() / 2);
		for (const auto& triangle : mesh.triangles)
			EXPECT_GT(normalOf(mesh, triangle).dot(mesh.vertices[triangle.vertices[0]] - middle), 0)
				<< kind;
	}
}

TEST(Primitives, HaveOnlyIndicesAndTexturesThatExist)
{
	for (const auto& kind : primitiveKinds())
	{
		const Mesh mesh = makePrimitive(kind, 5);
		for (const auto& triangle : mesh.triangles)
		{
			EXPECT_LT(triangle.material, mesh.materials.size()) << kind;
			for (const uint32_t vertex : triangle.vertices) EXPECT_LT(vertex, mesh.vertices.size());
		}
		for (const auto& material : mesh.materials)
			EXPECT_LT(material.texture, static_cast<int>(mesh.textures.size())) << kind;
		for (const auto& texture : mesh.textures) EXPECT_EQ(texture.type(), CV_8UC3) << kind;
	}
}

TEST(Primitives, AnUnknownKindNamesTheKnownOnes)
{
	const auto message = semloop::messageOf<semloop::InputError>([] { makePrimitive("robot", 1); });
	EXPECT_EQ(message, "no primitive 'robot'; there are: book box keyboard monitor mouse picture");
}
