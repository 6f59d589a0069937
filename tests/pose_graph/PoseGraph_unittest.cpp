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

TEST(PoseGraph, MergingMovesTheEdgesOfTheAbsorbedObject)
{
	CeresPoseGraph graph = twoCopies();
	const PoseEdge before = graph.edges()[2];
	const auto T_kept_absorbed = pose(0.05, 0, 0, 0.2);
	graph.mergeObjects(0, 1, T_kept_absorbed, true);

	EXPECT_FALSE(graph.has(NodeId::object(1)));
	ASSERT_EQ(graph.edges().size(), 3u);
	const PoseEdge& moved = graph.edges()[2];
	EXPECT_EQ(moved.a, NodeId::object(0));
	EXPECT_EQ(moved.b, NodeId::camera(1));
	EXPECT_EQ(moved.kind, Kind::Loop);
	EXPECT_LT(difference(moved.Z_a_b, T_kept_absorbed + before.Z_a_b), 1e-12);
	EXPECT_EQ(moved.information, before.information);
	EXPECT_EQ(graph.edges()[1].kind, Kind::Observation) << "the kept object's own edge";
}

TEST(PoseGraph, MergingWithoutALoopKeepsTheKindOfTheEdges)
{
	CeresPoseGraph graph = twoCopies();
	graph.mergeObjects(0, 1, {}, false);
	EXPECT_EQ(graph.edges()[2].kind, Kind::Observation);
}

TEST(PoseGraph, MergingObjectsThatStandAsMeasuredDoesNotChangeTheCost)
{
	// Wherever the absorbed object stands in an edge, first or second.
	CeresPoseGraph graph = twoCopies();
	std::mt19937 random(8);
	const PoseEdge turned{
		Kind::Observation, NodeId::camera(0), NodeId::object(1), pose(2, 1.3, 0.1, 0.2),
		randomInformation(random)};
	graph.addEdge(turned);
	graph.setNode(NodeId::camera(1), pose(1.1, 0.2, 0.1, 0.5));
	const double before = cost(graph);
	ASSERT_GT(before, 0.01);
	const auto T_kept_absorbed = -graph.pose(NodeId::object(0)) + graph.pose(NodeId::object(1));
	graph.mergeObjects(0, 1, T_kept_absorbed, true);
	EXPECT_EQ(graph.edges().back().b, NodeId::object(0));
	EXPECT_NEAR(cost(graph), before, 1e-10 * before);
}

TEST(PoseGraph, MergingDropsAnEdgeBetweenTheTwo)
{
	CeresPoseGraph graph = twoCopies();
	graph.addEdge({Kind::Loop, NodeId::object(1), NodeId::object(0), {}, Matrix6::Identity()});
	graph.mergeObjects(0, 1, {}, true);
	EXPECT_EQ(graph.edges().size(), 3u);
	for (const PoseEdge& edge : graph.edges()) EXPECT_FALSE(edge.a == edge.b);
}

TEST(PoseGraph, RefusesToMergeWhatIsNotThere)
{
	CeresPoseGraph graph = twoCopies();
	EXPECT_THROW(graph.mergeObjects(0, 7, {}, true), std::invalid_argument);
	EXPECT_THROW(graph.mergeObjects(7, 0, {}, true), std::invalid_argument);
	EXPECT_THROW(graph.mergeObjects(0, 0, {}, true), std::invalid_argument);
	EXPECT_EQ(graph.nodes().size(), 4u);
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
