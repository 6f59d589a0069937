#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/SemanticGraph.h>

#include <cmath>
#include <limits>

#include "GraphExamples.h"
#include "SyntheticScene.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using testing::AllOf;
using testing::HasSubstr;

SemanticGraph loadText(const std::string& text)
{
	const TemporaryFolder folder;
	return SemanticGraph::load(folder.write("graph.json", text));
}

std::string loadError(const std::string& text)
{
	return messageOf<InputError>([&] { loadText(text); });
}

std::string documentOf(const std::string& objects, const std::string& edges = "")
{
	return R"({"format": "semloop.graph/1", "objects": [)" + objects + R"(], "edges": [)" + edges +
		   "]}";
}

const char* const kCup = R"({"id": 1, "label": "cup", "position": [1, 2, 3]})";
const char* const kChair = R"({"id": 7, "label": "chair", "position": [1, 2, 5]})";

TEST(SemanticGraph, EdgesHaveNoDirection)
{
	SemanticGraph graph;
	graph.vertices = {vertex(0, "a", 0, 0, 0), vertex(1, "b", 3, 4, 0), vertex(2, "c", 0, 0, 1)};
	graph.edges = {{0, 1}};
	EXPECT_TRUE(graph.hasEdge(0, 1));
	EXPECT_TRUE(graph.hasEdge(1, 0));
	EXPECT_FALSE(graph.hasEdge(0, 2));
	EXPECT_FALSE(graph.hasEdge(1, 1));
	EXPECT_DOUBLE_EQ(graph.distance(1, 0), 5);
}

TEST(SemanticGraphFile, LoadsEveryField)
{
	const auto graph = loadText(documentOf(
		R"({"id": 3, "label": "chair", "position": [1, -2.5, 3], "label_scores": {"chair": 0.9,
			"couch": 0.1}, "embedding": [0.6, 0.8], "extent": [0.5, 0.4, 1], "orientation": [0, 0, 0.6, 0.8],
			"observations": 41, "completeness": 0.4},)" +
			std::string(kChair),
		"[7, 3]"));
	ASSERT_EQ(graph.vertices.size(), 2);
	const auto& chair = graph.vertices[0];
	EXPECT_EQ(chair.id, 3);
	EXPECT_EQ(chair.label, "chair");
	EXPECT_EQ(chair.position, mrpt::math::TPoint3D(1, -2.5, 3));
	EXPECT_DOUBLE_EQ(chair.labelScores.at("couch"), 0.1);
	EXPECT_EQ(chair.embeddings, (std::vector<std::vector<float>>{{0.6f, 0.8f}}));
	EXPECT_EQ(chair.extent->z, 1);
	EXPECT_EQ(chair.observations, 41);
	EXPECT_EQ(chair.completeness, 0.4);
	EXPECT_FALSE(graph.vertices[1].completeness);
	EXPECT_EQ(chair.orientation, mrpt::math::CQuaternionDouble(0.8, 0, 0, 0.6));
	EXPECT_FALSE(graph.vertices[1].orientation);
	EXPECT_FALSE(graph.vertices[1].extent);
	EXPECT_TRUE(graph.hasEdge(0, 1));
}

TEST(SemanticGraphFile, EmptyGraphIsValid)
{
	const auto graph = loadText(documentOf(""));
	EXPECT_TRUE(graph.vertices.empty());
	EXPECT_TRUE(graph.edges.empty());
}

TEST(SemanticGraphFile, SavingAndLoadingKeepsEverythingAndTheBytes)
{
	auto graph = complete({vertex(9, "cup \"A\"", 0.1, -1e-9, 3), vertex(4, "chair", 1, 2, 3)});
	graph.vertices[0].embeddings = {{0.6f, -0.8f}};
	graph.vertices[0].labelScores = {{"cup \"A\"", 0.75}, {"bowl", 0.25}};
	graph.vertices[1].extent.emplace(0.5, 0.5, 1);
	graph.vertices[1].orientation.emplace(std::sqrt(0.5), 0, 0, -std::sqrt(0.5));
	graph.vertices[1].observations = 3;
	graph.vertices[1].completeness = 0.6;
	const TemporaryFolder folder;
	graph.save(folder.file("a.json"));
	const auto loaded = SemanticGraph::load(folder.file("a.json"));
	loaded.save(folder.file("b.json"));

	EXPECT_EQ(readBytes(folder.file("a.json")), readBytes(folder.file("b.json")));
	ASSERT_EQ(loaded.vertices.size(), 2);
	EXPECT_EQ(loaded.vertices[0].id, 4) << "objects are in the order of their ids";
	EXPECT_EQ(loaded.vertices[0].observations, 3);
	EXPECT_EQ(loaded.vertices[0].completeness, 0.6);
	EXPECT_EQ(loaded.vertices[0].extent->z, 1);
	EXPECT_NEAR(loaded.vertices[0].orientation->z(), -std::sqrt(0.5), 1e-6);
	EXPECT_EQ(loaded.vertices[1].label, "cup \"A\"");
	EXPECT_EQ(loaded.vertices[1].embeddings, graph.vertices[0].embeddings);
	EXPECT_EQ(loaded.vertices[1].labelScores, graph.vertices[0].labelScores);
	EXPECT_EQ(loaded.edges, (decltype(loaded.edges){{0, 1}}));
	EXPECT_EQ(readBytes(folder.file("a.json")).find("-0.0"), std::string::npos)
		<< "no negative zero";
}

TEST(SemanticGraphFile, TheBytesDoNotDependOnTheOrderOfTheVertices)
{
	const auto graph = randomRoom(8, 3, 1);
	const TemporaryFolder folder;
	graph.save(folder.file("a.json"));
	reordered(graph, {3, 1, 0, 7, 6, 2, 4, 5}).save(folder.file("b.json"));
	EXPECT_EQ(readBytes(folder.file("a.json")), readBytes(folder.file("b.json")));
}

TEST(SemanticGraphFile, SeveralEmbeddingsAreSavedAsTheDirectionOfTheirMean)
{
	auto graph = complete({vertex(1, "cup", 0, 0, 0)});
	graph.vertices[0].embeddings = {{1, 0}, {0, 1}};
	const TemporaryFolder folder;
	graph.save(folder.file("a.json"));
	const auto embedding = SemanticGraph::load(folder.file("a.json")).vertices[0].embeddings.at(0);
	EXPECT_NEAR(embedding[0], std::sqrt(0.5), 1e-6);
	EXPECT_NEAR(embedding[1], std::sqrt(0.5), 1e-6);
}

TEST(SemanticGraphFile, RefusesToSaveWhatItCouldNotLoad)
{
	const TemporaryFolder folder;
	auto graph = complete({vertex(1, "cup", std::nan(""), 0, 0)});
	EXPECT_THAT(
		messageOf<InputError>([&] { graph.save(folder.file("a.json")); }),
		AllOf(HasSubstr("a.json"), HasSubstr("object 1"), HasSubstr("not finite")));
	graph = complete({vertex(1, "cup", 0, 0, 0), vertex(1, "cup", 1, 0, 0)});
	EXPECT_THAT(
		messageOf<InputError>([&] { graph.save(folder.file("a.json")); }), HasSubstr("id 1"));
	EXPECT_THAT(
		messageOf<InputError>([&] { fourObjects().save("/nowhere/graph.json"); }),
		HasSubstr("/nowhere/graph.json: cannot be written"));
}

TEST(SemanticGraphFile, AMissingFileIsNamed)
{
	EXPECT_THAT(
		messageOf<InputError>([] { SemanticGraph::load("/nowhere/graph.json"); }),
		HasSubstr("/nowhere/graph.json: cannot be opened"));
}

struct BadFile
{
	const char* name;
	std::string text;
	std::string place;
	std::string problem;
};

class SemanticGraphFileRejects : public testing::TestWithParam<BadFile>
{
};

TEST_P(SemanticGraphFileRejects, NamingFileAndPlaceInOneLine)
{
	const auto error = loadError(GetParam().text);
	EXPECT_THAT(
		error,
		AllOf(
			HasSubstr("graph.json: "), HasSubstr(GetParam().place), HasSubstr(GetParam().problem)));
	EXPECT_EQ(error.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
	Each, SemanticGraphFileRejects,
	testing::Values(
		BadFile{"Garbage", "{\"format\":", "line 1", "not valid JSON"},
		BadFile{"Array", "[1]", "document", "must be an object"},
		BadFile{"NoFormat", "{}", "document", "\"format\" is missing"},
		BadFile{
			"OtherFormat", R"({"format": "semloop.graph/2"})", "format",
			"is \"semloop.graph/2\", this program reads \"semloop.graph/1\""},
		BadFile{
			"NoObjects", R"({"format": "semloop.graph/1"})", "document", "\"objects\" is missing"},
		BadFile{
			"NoEdges", R"({"format": "semloop.graph/1", "objects": []})", "document",
			"\"edges\" is missing"},
		BadFile{
			"ObjectsNoArray", R"({"format": "semloop.graph/1", "objects": 3, "edges": []})",
			"objects", "must be an array"},
		BadFile{"ObjectNoObject", documentOf("3"), "objects[0]", "must be an object"},
		BadFile{
			"NegativeId", documentOf(R"({"id": -1, "label": "cup", "position": [1, 2, 3]})"),
			"objects[0].id", "integer >= 0, is -1"},
		BadFile{
			"DuplicateId", documentOf(std::string(kCup) + "," + kChair + "," + kCup),
			"objects[2].id", "1 is already the id of objects[0]"},
		BadFile{
			"EmptyLabel", documentOf(R"({"id": 1, "label": "", "position": [1, 2, 3]})"),
			"objects[0].label", "not empty"},
		BadFile{
			"ShortPosition", documentOf(R"({"id": 1, "label": "cup", "position": [1, 2]})"),
			"objects[0].position", "3 numbers"},
		BadFile{
			"NullPosition", documentOf(R"({"id": 1, "label": "cup", "position": [1, 2, null]})"),
			"objects[0].position[2]", "finite number, is null"},
		BadFile{
			"InfinitePosition",
			documentOf(R"({"id": 1, "label": "cup", "position": [1, 2, 1e999]})"), "1e999",
			"overflow"},
		BadFile{
			"Score",
			documentOf(
				R"({"id": 1, "label": "cup", "position": [1, 2, 3], "label_scores": {"cup": 1.5}})"),
			"objects[0].label_scores.cup", "[0, 1]"},
		BadFile{
			"LongEmbedding",
			documentOf(R"({"id": 1, "label": "cup", "position": [1, 2, 3], "embedding": [3, 4]})"),
			"objects[0].embedding", "length is 5"},
		BadFile{
			"EmbeddingSizes",
			documentOf(
				R"({"id": 1, "label": "cup", "position": [1, 2, 3], "embedding": [1, 0]},
				   {"id": 2, "label": "cup", "position": [1, 2, 3], "embedding": [1, 0, 0]})"),
			"objects[1].embedding", "has 3 numbers, the ones before have 2"},
		BadFile{
			"Completeness",
			documentOf(R"({"id": 1, "label": "cup", "position": [1, 2, 3], "completeness": 1.5})"),
			"objects[0].completeness", "must be in [0, 1]"},
		BadFile{
			"Extent",
			documentOf(R"({"id": 1, "label": "cup", "position": [1, 2, 3], "extent": [1, -1, 1]})"),
			"objects[0].extent", "negative"},
		BadFile{
			"ShortOrientation",
			documentOf(
				R"({"id": 1, "label": "cup", "position": [1, 2, 3], "orientation": [0, 0, 1]})"),
			"objects[0].orientation", "4 numbers"},
		BadFile{
			"LongOrientation",
			documentOf(
				R"({"id": 1, "label": "cup", "position": [1, 2, 3], "orientation": [0, 0, 3, 4]})"),
			"objects[0].orientation", "length is 5"},
		BadFile{
			"EdgeToUnknown", documentOf(std::string(kCup) + "," + kChair, "[1, 7], [1, 8]"),
			"edges[1][1]", "no object has the id 8"},
		BadFile{"EdgeToItself", documentOf(kCup, "[1, 1]"), "edges[0]", "object 1 to itself"},
		BadFile{"EdgeOfThree", documentOf(kCup, "[1, 1, 1]"), "edges[0]", "pair of ids"}),
	[](const auto& test) { return test.param.name; });

class SemanticGraphFromMap : public testing::Test
{
protected:
	/** Three balls, seen once; 0 and 1 co-visible, 1 and 2 too. */
	void SetUp() override
	{
		using namespace semloop::synthetic;
		Scene scene;
		for (int i = 0; i < 3; ++i)
			scene.spheres.push_back({{0, 0.5 * i - 0.5, 0}, 0.1, {0, 0, 200}, i + 1, 0});
		const auto T_world_camera = lookAt({1.5, 0, 0}, {0, 0, 0});
		const auto view = renderView(scene, smallCamera(), T_world_camera);
		map.setLabels(LabelSet({"ball", "apple"}));
		for (int i = 0; i < 3; ++i)
			ids.push_back(*map.addObject(
				view.frame, makeInstance(view.masks[i + 1], i == 1, 0.9f, {0.6f, 0.8f}),
				T_world_camera));
		map.fuse(ids[0], view.frame, makeInstance(view.masks[1], 0), T_world_camera);
		map.markCovisible({ids[0], ids[1]});
		map.markCovisible({ids[1], ids[2]});
	}

	CObjectMap map;
	std::vector<ObjectId> ids;
};

TEST_F(SemanticGraphFromMap, HasAVertexPerObjectAndAnEdgePerCovisiblePair)
{
	const auto graph = SemanticGraph::fromMap(map);
	ASSERT_EQ(graph.vertices.size(), 3);
	EXPECT_EQ(graph.edges, (decltype(graph.edges){{0, 1}, {1, 2}}));
	EXPECT_EQ(graph.vertices[0].id, ids[0]);
	EXPECT_EQ(graph.vertices[0].label, "ball");
	EXPECT_EQ(graph.vertices[1].label, "apple");
	EXPECT_NEAR(graph.vertices[1].labelScores.at("apple"), 0.9, 1e-6);
	EXPECT_EQ(graph.vertices[1].embeddings.size(), 1);
	EXPECT_EQ(graph.vertices[0].observations, 2);
	EXPECT_EQ(graph.vertices[0].position, map.object(ids[0]).centre());
	EXPECT_NEAR(graph.distance(0, 1), 0.5, 0.05);
	EXPECT_GT(graph.vertices[0].extent->y, 0.1);
	EXPECT_EQ(graph.vertices[0].orientation, mrpt::math::CQuaternionDouble(1, 0, 0, 0));
}

TEST_F(SemanticGraphFromMap, TakesOnlyTheSubsetAndTheEdgesInsideIt)
{
	const auto graph = SemanticGraph::fromMap(map, {ids[1], ids[2], 12345});
	ASSERT_EQ(graph.vertices.size(), 2);
	EXPECT_EQ(graph.vertices[0].id, ids[1]);
	EXPECT_EQ(graph.edges, (decltype(graph.edges){{0, 1}}));
}

TEST_F(SemanticGraphFromMap, LeavesOutWhatWasSeenTooSeldom)
{
	const auto graph = SemanticGraph::fromMap(map, 2);
	ASSERT_EQ(graph.vertices.size(), 1);
	EXPECT_EQ(graph.vertices[0].id, ids[0]);
	EXPECT_TRUE(graph.edges.empty());
}
}  // namespace
