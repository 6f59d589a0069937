#include <gtest/gtest.h>
#include <semloop/association/NearestNeighbourAssociator.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/pose_graph/PoseResidual.h>
#include <semloop/slam/LoopCloser.h>

#include <random>

#include "SyntheticScene.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
/** A box, and the same box again, mapped under a drift. */
class LoopCloserTest : public testing::Test
{
protected:
	LoopCloserTest()
	{
		map->setLabels(LabelSet({"box"}));
		graph->setNode(NodeId::camera(0), T_world_camera);
		target = add(CPose3D());
		query = add(drift);
	}

	/** Twice, so that box centre and object frame differ; the frame is turned after a correction. */
	ObjectId add(const CPose3D& wrong)
	{
		Scene scene;
		scene.boxes.push_back({CPose3D(0, 0, 0.8, 0.4, 0, 0), {0.2, 0.3, 0.2}, {200, 0, 0}, 1, 0});
		const View view = renderView(scene, makeCamera(160, 120, 100), T_world_camera);
		const Instance instance = makeInstance(view.masks[1], 0);
		const ObjectId id = map->addObject(view.frame, instance, wrong + T_world_camera).value();
		const CPose3D turned = map->object(id).T_world_object + CPose3D(0.1, 0, 0, 0.3, 0, 0);
		map->moveObjects({{id, turned}});
		const NodeId node = NodeId::object(id);
		graph->setNode(node, turned);
		graph->addEdge(
			{PoseEdge::Kind::Observation, node, NodeId::camera(0), (-turned) + T_world_camera,
			 0.01 * Matrix6::Identity()});
		localMap.see(id);
		return id;
	}

	LoopVerdict verdict(const CPose3D& T_target_query) const
	{
		LoopVerdict result;
		result.decision = LoopVerdict::Decision::Accepted;
		result.matches = {{query, target}};
		result.T_target_query = T_target_query;
		return result;
	}

	const CPose3D T_world_camera = lookAt({1.4, 0.3, 1.3}, {0, 0, 0.8});
	const CPose3D drift = CPose3D(0.3, -0.1, 0.05, 0.2, 0, 0);
	CObjectMap::Ptr map = CObjectMap::Create();
	CeresPoseGraph::Ptr graph = CeresPoseGraph::Create();
	StageTimings timings;
	LocalMap localMap;
	ObjectId target = 0, query = 0;
	LoopCloser closer{map, graph, nullptr, timings};
	ObjectMapper mapper{map, std::make_shared<NearestNeighbourAssociator>(), timings};
};

RigidTransform rigid(const CPose3D& pose)
{
	return RigidTransform::fromPose(pose);
}

TEST_F(LoopCloserTest, TheEdgeSaysWhatTheAlignmentSaysAboutTheCentre)
{
	std::mt19937 random(4);
	std::normal_distribution<double> normal;
	const Matrix6 root = Matrix6::NullaryExpr([&] { return normal(random); });
	MatchAlignment alignment{-drift, root * root.transpose() + Matrix6::Identity()};
	LoopVerdict found = verdict(-drift);
	found.alignments = {alignment};
	const CPose3D T_world_query = map->object(query).T_world_object;
	const CPose3D T_world_target = map->object(target).T_world_object;
	const CPose3D C = CPose3D::FromTranslation(map->object(query).centre());
	ASSERT_GT((C.translation() - T_world_query.translation()).norm(), 0.02);

	closer.close(found, localMap, mapper);
	const PoseEdge& edge = graph->edges().back();
	EXPECT_EQ(edge.kind, PoseEdge::Kind::Loop);
	for (int i = 0; i < 20; ++i)
	{
		const Vector6 d = Vector6::NullaryExpr([&] { return 1e-4 * normal(random); });
		const CPose3D moved = -drift + C + exponential(d).toPose() + ((-C) + T_world_query);
		const Vector6 e = poseResidual(rigid(edge.Z_a_b), rigid(T_world_target), rigid(moved));
		const double expected = d.dot(alignment.information * d);
		EXPECT_NEAR(e.dot(edge.information * e), expected, 1e-3 * expected);
	}
}

TEST_F(LoopCloserTest, TheMatchedObjectsBecomeOneAndLeaveTheLocalMap)
{
	closer.close(verdict(-drift), localMap, mapper);
	ASSERT_EQ(map->objects().size(), 1U);
	EXPECT_EQ(map->objects().begin()->first, target);
	EXPECT_EQ(map->object(target).observations, 2);
	EXPECT_TRUE(localMap.objects().empty());
	EXPECT_FALSE(localMap.isLoopDue());
	EXPECT_TRUE(graph->has(NodeId::object(query))) << "what was measured against it stays";
	EXPECT_NO_THROW(closer.optimize());
}

TEST_F(LoopCloserTest, ObjectsStayTwoWhereOtherMeasurementsContradictTheLoop)
{
	// Both are firmly tied to the camera, and the loop claims that one stands elsewhere.
	for (const ObjectId id : {query, target})
	{
		const NodeId node = NodeId::object(id);
		graph->addEdge(
			{PoseEdge::Kind::Observation, node, NodeId::camera(0),
			 (-graph->pose(node)) + T_world_camera, 1e6 * Matrix6::Identity()});
	}
	closer.close(verdict(CPose3D(3, 0, 0, 0, 0, 0)), localMap, mapper);
	EXPECT_EQ(map->objects().size(), 2U);
}

TEST_F(LoopCloserTest, ALoopOfTwoCamerasCorrectsTheLaterOneAndWhatItSaw)
{
	// The second camera has drifted together with its object; in truth it is where the first one is.
	const NodeId camera = NodeId::camera(1), node = NodeId::object(query);
	graph->setNode(camera, drift + T_world_camera);
	graph->addEdge(
		{PoseEdge::Kind::Observation, node, camera, (-graph->pose(node)) + drift + T_world_camera,
		 1e4 * Matrix6::Identity()});
	LoopVerdict found;
	found.decision = LoopVerdict::Decision::Accepted;
	found.cameras = {{1, 0, CPose3D(), 1e4 * Matrix6::Identity(), 50}};
	closer.close(found, localMap, mapper);

	const PoseEdge& edge = graph->edges().back();
	EXPECT_EQ(edge.kind, PoseEdge::Kind::Loop);
	EXPECT_EQ(edge.a, NodeId::camera(0));
	EXPECT_EQ(edge.b, camera);
	EXPECT_LT((graph->pose(camera) - T_world_camera).translation().norm(), 0.01);
	EXPECT_EQ(map->objects().size(), 1U) << "the two boxes stand in one place now";
}

TEST_F(LoopCloserTest, AVerdictThatBreaksTheRulesChangesNothing)
{
	LoopVerdict twice = verdict(-drift);
	twice.matches.push_back(twice.matches.front());
	EXPECT_THROW(closer.close(twice, localMap, mapper), std::logic_error);
	LoopVerdict more = verdict(-drift);
	more.alignments.resize(2);
	EXPECT_THROW(closer.close(more, localMap, mapper), std::logic_error);
	EXPECT_EQ(graph->edges().size(), 2U);
	EXPECT_EQ(map->objects().size(), 2U);
}
}  // namespace
