#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/pose_graph/G2oFile.h>

#include <random>
#include <stdexcept>
#include <string>

#include "Fixtures.h"
#include "TemporaryFolder.h"

namespace semloop
{
namespace
{
using Kind = PoseEdge::Kind;
using testing::HasSubstr;

const std::string kUnitInformation = " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1";

class G2oFile : public testing::Test
{
protected:
	void write(const std::string& text) const { folder_.write("graph.g2o", text); }
	/** The message of the InputError that this file causes. */
	std::string errorOf(const std::string& text) const
	{
		write(text);
		CeresPoseGraph graph;
		try
		{
			readG2o(path_, graph);
		}
		catch (const InputError& error)
		{
			EXPECT_THAT(error.what(), HasSubstr(path_)) << "the file is not named";
			return error.what();
		}
		return "no error";
	}

	TemporaryFolder folder_;
	std::string path_ = folder_.file("graph.g2o");
};

/** Cameras and objects, every kind of edge, and a fixed camera that is not the first. */
CeresPoseGraph mixedGraph()
{
	CeresPoseGraph graph;
	std::mt19937 random(21);
	const auto add = [&](NodeId id)
	{ graph.setNode(id, exponential(randomVector(random, 5, 1.7)).toPose()); };
	for (const uint64_t i : {30, 10, 20, 40}) add(NodeId::camera(i));
	for (const uint64_t i : {0, 7}) add(NodeId::object(i));
	const auto join = [&](Kind kind, NodeId a, NodeId b)
	{
		graph.addEdge(
			{kind, a, b, exponential(randomVector(random, 5, 1.7)).toPose(),
			 randomInformation(random)});
	};
	join(Kind::Odometry, NodeId::camera(10), NodeId::camera(20));
	join(Kind::Observation, NodeId::object(7), NodeId::camera(20));
	join(Kind::Loop, NodeId::object(0), NodeId::camera(40));
	join(Kind::Loop, NodeId::camera(10), NodeId::camera(40));
	join(Kind::Loop, NodeId::camera(20), NodeId::camera(30));
	join(Kind::Odometry, NodeId::camera(40), NodeId::camera(10));
	return graph;
}

TEST_F(G2oFile, RoundTripKeepsNodesEdgesKindsAndTheFixedCamera)
{
	for (const auto rotation : {G2oRotation::RotationVector, G2oRotation::QuaternionVector})
	{
		const CeresPoseGraph written = mixedGraph();
		writeG2o(path_, written, rotation);
		CeresPoseGraph read;
		readG2o(path_, read, rotation);

		EXPECT_EQ(read.fixedCamera(), NodeId::camera(30));
		ASSERT_EQ(read.nodes().size(), written.nodes().size());
		for (const auto& [id, T] : written.nodes())
			EXPECT_LT(difference(T, read.pose(id)), 1e-14) << toString(id);
		ASSERT_EQ(read.edges().size(), written.edges().size());
		for (std::size_t i = 0; i < read.edges().size(); ++i)
		{
			const PoseEdge &a = written.edges()[i], &b = read.edges()[i];
			EXPECT_EQ(a.kind, b.kind) << i;
			EXPECT_EQ(a.a, b.a);
			EXPECT_EQ(a.b, b.b);
			EXPECT_LT(difference(a.Z_a_b, b.Z_a_b), 1e-14);
			EXPECT_EQ(a.information, b.information) << "every bit: the factors are powers of two";
		}
	}
}

TEST_F(G2oFile, AnEmptyGraphComesBackEmpty)
{
	writeG2o(path_, CeresPoseGraph());
	CeresPoseGraph read;
	readG2o(path_, read);
	EXPECT_TRUE(read.nodes().empty());
	EXPECT_FALSE(read.fixedCamera());
}

TEST_F(G2oFile, ReadsAFileByHandWithItsRecordsInAnyOrder)
{
	write(
		"# a comment\n\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
		"EDGE_SE3:QUAT 0 1 1 2 3 0 0 0.70710678118654752 0.70710678118654752" +
		kUnitInformation + "\nVERTEX_SE3:QUAT 1 1 2 3 0 0 1 0\n");
	CeresPoseGraph graph;
	readG2o(path_, graph);
	EXPECT_LT(difference(graph.pose(NodeId::camera(1)), pose(1, 2, 3, kPi)), 1e-14);
	ASSERT_EQ(graph.edges().size(), 1u);
	EXPECT_LT(difference(graph.edges()[0].Z_a_b, pose(1, 2, 3, kPi / 2)), 1e-14);
}

TEST_F(G2oFile, TheInformationIsTheUpperTriangleByRows)
{
	write(
		"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n"
		"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1"
		" 101 2 3 4 5 6 102 7 8 9 10 103 11 12 13 104 14 15 105 16 106\n");
	CeresPoseGraph graph;
	readG2o(path_, graph);
	const Matrix6& m = graph.edges().at(0).information;
	EXPECT_EQ(m(0, 5), 6);
	EXPECT_EQ(m(5, 0), 6);
	EXPECT_EQ(m(1, 1), 102);
	EXPECT_EQ(m(2, 3), 11);
	EXPECT_EQ(m(4, 5), 16);
	EXPECT_EQ(m(5, 5), 106);

	CeresPoseGraph asG2o;
	readG2o(path_, asG2o, G2oRotation::QuaternionVector);
	const Matrix6& q = asG2o.edges().at(0).information;
	EXPECT_EQ(q(1, 1), 102);
	EXPECT_EQ(q(0, 5), 3) << "half: one side is a quaternion's vector";
	EXPECT_EQ(q(5, 5), 26.5) << "a quarter: both are";
}

TEST_F(G2oFile, QuaternionConventionGivesTheCostThatG2oComputes)
{
	// A turn of 0.02 rad against information 4 for the quaternion's vector part: sin(0.01)^2 * 4 / 2.
	write(
		"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0.00999983333 0.99995\n"
		"EDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1 4 0 0 0 0 0 4 0 0 0 0 4 0 0 0 4 0 0 4 0 4\n");
	CeresPoseGraph graph;
	readG2o(path_, graph, G2oRotation::QuaternionVector);
	EXPECT_NEAR(cost(graph), 0.5 * 4 * 0.01 * 0.01, 1e-8);
}

TEST_F(G2oFile, ForeignFilesHoldCamerasWithNeighboursAsOdometry)
{
	write(
		"VERTEX_SE3:QUAT 5 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 2 1 0 0 0 0 0 1\n"
		"VERTEX_SE3:QUAT 1000000 1 0 0 0 0 0 1\nEDGE_SE3:QUAT 5 2 1 0 0 0 0 0 1" +
		kUnitInformation + "\nEDGE_SE3:QUAT 2 1000000 1 0 0 0 0 0 1" + kUnitInformation + "\n");
	CeresPoseGraph graph;
	readG2o(path_, graph);
	EXPECT_EQ(*graph.fixedCamera(), NodeId::camera(5)) << "the first vertex of the file";
	EXPECT_EQ(graph.edges()[0].kind, Kind::Odometry);
	EXPECT_EQ(graph.edges()[1].kind, Kind::Loop);
	EXPECT_TRUE(graph.has(NodeId::camera(1000000)));
}

TEST_F(G2oFile, ObjectsGetIdsBeyondTheCameras)
{
	CeresPoseGraph graph;
	graph.setNode(NodeId::camera(1500), {});
	graph.setNode(NodeId::object(3), {});
	writeG2o(path_, graph);
	EXPECT_THAT(readBytes(path_), HasSubstr("# semloop first_object_id 10000\n"));
	EXPECT_THAT(readBytes(path_), HasSubstr("VERTEX_SE3:QUAT 10003 "));
	EXPECT_THAT(readBytes(path_), HasSubstr("FIX 1500\n"));
}

TEST_F(G2oFile, ErrorsNameTheLineAndWhatIsWrong)
{
	const std::string two = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n";
	EXPECT_THAT(errorOf("VERTEX_SE2 0 0 0 0\n"), HasSubstr(":1: unknown record VERTEX_SE2"));
	EXPECT_THAT(
		errorOf(two + "VERTEX_SE3:QUAT 2 1 0 0 0"), HasSubstr(":3: VERTEX_SE3:QUAT needs 8"));
	EXPECT_THAT(
		errorOf(two + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0"), HasSubstr("is the file cut?"));
	EXPECT_THAT(errorOf("VERTEX_SE3:QUAT 0 nan 0 0 0 0 0 1"), HasSubstr(":1: nan is not finite"));
	EXPECT_THAT(errorOf("VERTEX_SE3:QUAT 0 1e999 0 0 0 0 0 1"), HasSubstr("1e999 is out of"));
	EXPECT_THAT(errorOf("VERTEX_SE3:QUAT 0 x 0 0 0 0 0 1"), HasSubstr(":1: x is not a number"));
	EXPECT_THAT(errorOf("VERTEX_SE3:QUAT -1 0 0 0 0 0 0 1"), HasSubstr("-1 is not an id"));
	EXPECT_THAT(errorOf("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0"), HasSubstr("quaternion's length"));
	EXPECT_THAT(
		errorOf(two + "VERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n"),
		HasSubstr(":3: vertex 1 is there already, in line 2"));
	EXPECT_THAT(
		errorOf(two + "\nEDGE_SE3:QUAT 0 7 1 0 0 0 0 0 1" + kUnitInformation),
		HasSubstr(":4: no vertex 7"));
	EXPECT_THAT(
		errorOf(two + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 2 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"),
		HasSubstr("not symmetric positive definite"));
	EXPECT_THAT(errorOf(two + "FIX 9\n"), HasSubstr(":3: FIX 9: no such camera"));
	EXPECT_THAT(errorOf(two + "FIX 0\nFIX 1\n"), HasSubstr(":4: a second FIX"));
	EXPECT_THAT(
		errorOf(two + "# semloop kind maybe\n"), HasSubstr(":3: unknown kind of edge maybe"));
	EXPECT_THAT(
		errorOf("# semloop first_object_id 1\n" + two + "FIX 1\n"), HasSubstr("no such camera"));
}

TEST_F(G2oFile, EmptyFilesAreEmptyGraphsAndMissingOnesAreErrors)
{
	EXPECT_EQ(errorOf(""), "no error");
	CeresPoseGraph graph;
	EXPECT_THROW(readG2o("/no/such/file.g2o", graph), InputError);
	EXPECT_THROW(writeG2o("/no/such/folder/x.g2o", graph), InputError);
}

TEST_F(G2oFile, ReadingIntoAGraphThatHasNodesIsRefused)
{
	write("");
	CeresPoseGraph graph = mixedGraph();
	EXPECT_THROW(readG2o(path_, graph), std::invalid_argument);
}

TEST_F(G2oFile, IdsBeyondWhatG2oCanHoldAreRefused)
{
	CeresPoseGraph graph;
	graph.setNode(NodeId::camera(uint64_t(1) << 31), {});
	EXPECT_THROW(writeG2o(path_, graph), InputError);
}
}  // namespace
}  // namespace semloop
