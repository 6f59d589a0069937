#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/pose_graph/CeresPoseGraph.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "Fixtures.h"

namespace semloop
{
namespace
{
using Kind = PoseEdge::Kind;
using testing::HasSubstr;

/** Two cameras that see objects 0 and 1, which are one object after a drift. */
CeresPoseGraph twoCopies()
{
	CeresPoseGraph graph;
	graph.setNode(NodeId::camera(0), pose(0, 0));
	graph.setNode(NodeId::camera(1), pose(1, 0, 0, 0.3));
	graph.setNode(NodeId::object(0), pose(2, 1, 0, 0.1));
	graph.setNode(NodeId::object(1), pose(2.2, 1.1, 0, 0.4));
	std::mt19937 random(7);
	const auto seen = [&](NodeId a, NodeId b, Kind kind) {
		graph.addEdge({kind, a, b, -graph.pose(a) + graph.pose(b), randomInformation(random)});
	};
	seen(NodeId::camera(0), NodeId::camera(1), Kind::Odometry);
	seen(NodeId::object(0), NodeId::camera(0), Kind::Observation);
	seen(NodeId::object(1), NodeId::camera(1), Kind::Observation);
	return graph;
}

TEST(PoseGraph, HoldsTheFirstCameraThatWasAddedAndNotTheSmallestIndex)
{
	CeresPoseGraph graph;
	EXPECT_FALSE(graph.fixedCamera());
	graph.setNode(NodeId::object(0), pose(0, 0));
	EXPECT_FALSE(graph.fixedCamera());
	graph.setNode(NodeId::camera(5), pose(0, 0));
	graph.setNode(NodeId::camera(1), pose(1, 0));
	EXPECT_EQ(*graph.fixedCamera(), NodeId::camera(5));
}

TEST(PoseGraph, SettingANodeAgainMovesIt)
{
	CeresPoseGraph graph;
	graph.setNode(NodeId::camera(0), pose(0, 0));
	graph.setNode(NodeId::camera(0), pose(3, 0));
	EXPECT_EQ(graph.nodes().size(), 1u);
	EXPECT_DOUBLE_EQ(graph.pose(NodeId::camera(0)).x(), 3);
}

TEST(PoseGraph, RefusesAPoseThatIsNotFinite)
{
	CeresPoseGraph graph;
	const double nan = std::numeric_limits<double>::quiet_NaN();
	EXPECT_THROW(graph.setNode(NodeId::camera(0), pose(nan, 0)), std::invalid_argument);
	EXPECT_THROW(graph.setNode(NodeId::camera(0), pose(0, 0, 0, nan)), std::invalid_argument);
	EXPECT_TRUE(graph.nodes().empty());
}

TEST(PoseGraph, AnUnknownNodeIsNamed)
{
	CeresPoseGraph graph = twoCopies();
	try
	{
		graph.addEdge(
			{Kind::Odometry, NodeId::camera(1), NodeId::camera(9), {}, Matrix6::Identity()});
		FAIL() << "took an edge to a node that is not there";
	}
	catch (const std::invalid_argument& error)
	{
		EXPECT_THAT(error.what(), HasSubstr("camera 9 is not in the graph"));
	}
	EXPECT_THROW(graph.pose(NodeId::object(9)), std::out_of_range);
}

TEST(PoseGraph, RefusesInformationThatIsNotSymmetricPositiveDefinite)
{
	CeresPoseGraph graph = twoCopies();
	PoseEdge edge{Kind::Odometry, NodeId::camera(0), NodeId::camera(1), {}, Matrix6::Identity()};
	edge.information(0, 1) = 0.5;
	EXPECT_THROW(graph.addEdge(edge), std::invalid_argument) << "not symmetric";
	edge.information = Matrix6::Identity();
	edge.information(5, 5) = 0;
	EXPECT_THROW(graph.addEdge(edge), std::invalid_argument) << "singular";
	edge.information(5, 5) = -1;
	EXPECT_THROW(graph.addEdge(edge), std::invalid_argument) << "negative";
	edge.information(5, 5) = std::numeric_limits<double>::infinity();
	EXPECT_THROW(graph.addEdge(edge), std::invalid_argument) << "infinite";
	EXPECT_EQ(graph.edges().size(), 3u);
}

TEST(PoseGraph, RefusesAnEdgeFromANodeToItself)
{
	CeresPoseGraph graph = twoCopies();
	const NodeId camera = NodeId::camera(0);
	EXPECT_THROW(
		graph.addEdge({Kind::Loop, camera, camera, {}, Matrix6::Identity()}),
		std::invalid_argument);
}

TEST(PoseGraph, RemovingAnObjectTakesItsEdgesAlong)
{
	CeresPoseGraph graph = twoCopies();
	graph.removeObject(0);
	EXPECT_FALSE(graph.has(NodeId::object(0)));
	EXPECT_EQ(graph.edges().size(), 2u);
	EXPECT_THROW(graph.removeObject(0), std::invalid_argument);
}
}  // namespace
}  // namespace semloop
