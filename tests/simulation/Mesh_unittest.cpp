#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/Mesh.h>

using Eigen::Vector3f;
using semloop::boundsOf;
using semloop::Mesh;

TEST(Mesh, HasTheBoundsOfItsVertices)
{
	Mesh mesh;
	mesh.vertices = {{1, -2, 3}, {-1, 5, 3.5F}, {0, 0, 4}};
	const auto bounds = boundsOf(mesh);
	EXPECT_EQ(bounds.minimum, Vector3f(-1, -2, 3));
	EXPECT_EQ(bounds.maximum, Vector3f(1, 5, 4));
	EXPECT_EQ(bounds.size(), Vector3f(2, 7, 1));
}

TEST(Mesh, OfOneVertexHasNoSize)
{
	Mesh mesh;
	mesh.vertices = {{1, 2, 3}};
	EXPECT_EQ(boundsOf(mesh).minimum, Vector3f(1, 2, 3));
	EXPECT_EQ(boundsOf(mesh).size(), Vector3f(0, 0, 0));
}

TEST(Mesh, WithoutVerticesHasNoBounds)
{
	EXPECT_THROW(boundsOf(Mesh()), semloop::InputError);
}
