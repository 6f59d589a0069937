#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/MapIndex.h>

#include <algorithm>
#include <random>

#include "SyntheticScene.h"

using namespace semloop;
using namespace semloop::synthetic;
using mrpt::poses::CPose3D;
using testing::HasSubstr;

namespace
{
std::vector<ObjectId> idsOf(const GraphIndex& index)
{
	std::vector<ObjectId> ids;
	for (std::size_t i = 0; i < index.size(); ++i) ids.push_back(index.id(i));
	std::sort(ids.begin(), ids.end());
	return ids;
}

GraphVertex vertex(ObjectId id, const std::string& label, double x, std::vector<float> embedding)
{
	GraphVertex result;
	result.id = id;
	result.label = label;
	result.position = {x, 0.5 * x, 0};
	if (!embedding.empty()) result.embeddings = {std::move(embedding)};
	return result;
}

/** Says the same as an index that was made of the same vertices at once, whatever their numbers. */
void expectSame(const GraphIndex& index, const std::map<ObjectId, GraphVertex>& vertices)
{
	SemanticGraph graph;
	for (const auto& [id, v] : vertices) graph.vertices.push_back(v);
	const GraphIndex fresh(graph);
	ASSERT_EQ(idsOf(index), idsOf(fresh));
	EXPECT_EQ(index.labels(), fresh.labels());
	EXPECT_DOUBLE_EQ(index.area(), fresh.area());
	ASSERT_EQ(index.embeddings().size(), fresh.embeddings().size());
	for (std::size_t i = 0; i < index.size(); ++i)
	{
		const auto& v = vertices.at(index.id(i));
		EXPECT_EQ(index.point(i), v.position);
		EXPECT_EQ(index.labelOf(i), index.labelNumber(v.label));
		EXPECT_EQ(index.hasEmbedding(i), !v.embeddings.empty());
		if (index.embeddings().size() == 0) continue;
		for (Eigen::Index row = 0; row < index.embeddings().rows(); ++row)
			EXPECT_EQ(
				index.embeddings()(row, Eigen::Index(i)),
				v.embeddings.empty() ? 0.f : v.embeddings[0][std::size_t(row)]);
	}
	for (const auto& [id, v] : vertices)
	{
		const auto& mine = index.ofLabel(index.labelNumber(v.label));
		const auto& theirs = fresh.ofLabel(fresh.labelNumber(v.label));
		ASSERT_EQ(mine.size(), theirs.size());
		for (std::size_t i = 0; i < mine.size(); ++i)
		{
			EXPECT_EQ(mine[i].x, theirs[i].x);
			EXPECT_EQ(mine[i].x, float(index.point(mine[i].vertex).x));
		}
	}
}

TEST(GraphIndex, KeptUpToDateItSaysWhatOneMadeAnewSays)
{
	std::mt19937 random(3);
	const auto any = [&](int n) { return int(random() % unsigned(n)); };
	GraphIndex index;
	std::map<ObjectId, GraphVertex> vertices;
	for (ObjectId id = 1; id <= 300; ++id)
	{
		// Grows, and shrinks again.
		const bool remove = !vertices.empty() && (id > 150 || any(3) == 0);
		if (remove)
		{
			const auto number = std::size_t(any(int(index.size())));
			vertices.erase(index.id(number));
			index.remove(number);
		}
		if (!remove || any(2) == 0)
		{
			const std::vector<std::vector<float>> looks = {{}, {1, 0}, {0, 1}, {-1, 0}};
			const auto v = vertex(
				id, std::string(1, char('a' + any(4))), double(any(40)),
				looks[std::size_t(any(4))]);
			vertices[id] = v;
			index.add(v);
		}
		if (id % 10 == 0) expectSame(index, vertices);
	}
}

TEST(GraphIndex, WhatItDoesNotTakeChangesNothing)
{
	GraphIndex index;
	index.add(vertex(1, "a", 0, {1, 0}));
	EXPECT_THROW(index.add(vertex(2, "b", 0, {1, 0, 0})), InputError);
	EXPECT_THROW(index.add(vertex(3, "b", NAN, {1, 0})), InputError);
	EXPECT_EQ(index.size(), 1u);
	EXPECT_EQ(index.labels(), 1u);
	// When the last one with an embedding has gone, another network's are as good.
	index.remove(0);
	index.add(vertex(2, "b", 0, {1, 0, 0}));
	EXPECT_EQ(index.embeddings().rows(), 3);
}

TEST(MapIndex, DescribesOnlyWhatChanged)
{
	Scene scene;
	for (int i = 0; i < 3; ++i)
		scene.boxes.push_back(
			{CPose3D(0, 0.6 * i - 0.6, 0.8, 0, 0, 0), {0.2, 0.2, 0.2}, {200, 0, 0}, i + 1, 0});
	const auto T_world_camera = lookAt({1.8, 0, 1.4}, {0, 0, 0.8});
	const auto view = renderView(scene, makeCamera(320, 240, 200), T_world_camera);
	CObjectMap map;
	map.setLabels(LabelSet({"box", "chair", "lamp"}));
	std::vector<ObjectId> ids;
	for (int i = 0; i < 3; ++i)
		ids.push_back(
			map.addObject(view.frame, makeInstance(view.masks[i + 1], i), T_world_camera).value());
	const std::set<ObjectId> all(ids.begin(), ids.end());

	MapIndex kept;
	EXPECT_EQ(idsOf(kept.update(map, all, 1)), ids);
	EXPECT_EQ(kept.described(), 3u);
	kept.update(map, all, 1);
	EXPECT_EQ(kept.described(), 3u) << "nothing changed";

	map.moveObjects({{ids[1], CPose3D(0.5, 0, 0, 0, 0, 0) + map.object(ids[1]).T_world_object}});
	map.fuse(ids[2], view.frame, makeInstance(view.masks[3], 2), T_world_camera);
	const GraphIndex& index = kept.update(map, all, 1);
	EXPECT_EQ(kept.described(), 5u);
	for (std::size_t i = 0; i < index.size(); ++i)
		EXPECT_EQ(index.point(i), map.object(index.id(i)).centre());

	EXPECT_EQ(idsOf(kept.update(map, all, 2)), std::vector<ObjectId>{ids[2]});
	EXPECT_EQ(
		idsOf(kept.update(map, {ids[0], ids[1]}, 1)), (std::vector<ObjectId>{ids[0], ids[1]}));
	EXPECT_EQ(kept.described(), 7u);
	map.mergeObjects(ids[0], ids[1]);
	EXPECT_EQ(idsOf(kept.update(map, all, 1)), (std::vector<ObjectId>{ids[0], ids[2]}));
}
}  // namespace
