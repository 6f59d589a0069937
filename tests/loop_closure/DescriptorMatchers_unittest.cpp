#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/DescriptorMatchers.h>

#include <cmath>

#include "GraphFixtures.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;

/** vase - lamp - chair - table - chair - sofa - cat: the chairs differ by their ends. */
SemanticGraph chain()
{
	SemanticGraph graph;
	for (const char* label : {"vase", "lamp", "chair", "table", "chair", "sofa", "cat"})
	{
		const auto i = graph.vertices.size();
		graph.vertices.push_back(vertex(i, label, double(i), 0, 0));
		if (i > 0) graph.edges.insert({i - 1, i});
	}
	return graph;
}

template <class Matcher>
class DescriptorMatchers : public testing::Test
{
};
using Both = testing::Types<RandomWalkMatcher, HistogramMatcher>;
TYPED_TEST_SUITE(DescriptorMatchers, Both);

TYPED_TEST(DescriptorMatchers, NeighboursTellVerticesOfOneLabelApart)
{
	const auto turned = reordered(chain(), {6, 5, 4, 3, 2, 1, 0});
	const auto matching = TypeParam().match(chain(), turned);
	ASSERT_EQ(matching.matches.size(), 7u);
	for (const auto& match : matching.matches) EXPECT_EQ(match.query + match.target, 6u);
}

TYPED_TEST(DescriptorMatchers, DistancesPlayNoPart)
{
	const auto far = moved(chain(), yawPose(5, 5, 5, 1));
	auto stretched = far;
	for (auto& v : stretched.vertices) v.position *= 3;
	EXPECT_EQ(TypeParam().match(chain(), stretched).score, TypeParam().match(chain(), far).score);
}

TYPED_TEST(DescriptorMatchers, NeverMatchDifferentLabelsNorTheEmpty)
{
	const auto strangers = complete({vertex(0, "boat", 0, 0, 0), vertex(1, "lamp", 1, 0, 0)});
	EXPECT_EQ(TypeParam().match(strangers, chain()).matches, (std::vector<Match>{{1, 1}}));
	EXPECT_TRUE(TypeParam().match({}, chain()).matches.empty());
	EXPECT_TRUE(TypeParam().match(chain(), {}).matches.empty());
}

TYPED_TEST(DescriptorMatchers, GiveTheSameTwice)
{
	const auto a = randomRoom(12, 4, 1), b = randomRoom(30, 4, 2);
	const auto first = TypeParam().match(a, b), second = TypeParam().match(a, b);
	EXPECT_EQ(first.matches, second.matches);
	EXPECT_EQ(first.score, second.score);
}

TYPED_TEST(DescriptorMatchers, RefuseWhatWouldTakeMinutes)
{
	SemanticGraph field;
	for (int i = 0; i < 2000; ++i) field.vertices.push_back(vertex(ObjectId(i), "chair", i, 0, 0));
	EXPECT_THROW(TypeParam().match(field, field), InputError);
}

TEST(HistogramMatcher, TheSimilarityIsTheCosineOfPathCounts)
{
	// From the lamp: one path lamp-chair-table here; there also lamp-chair-cup: cosine 1 / sqrt(2).
	SemanticGraph query;
	query.vertices = {
		vertex(0, "lamp", 0, 0, 0), vertex(1, "chair", 1, 0, 0), vertex(2, "table", 2, 0, 0)};
	query.edges = {{0, 1}, {1, 2}};
	auto target = query;
	target.vertices.push_back(vertex(3, "cup", 0, 0, 0));
	target.edges.insert({1, 3});
	// The chair begins no path of two edges; the table's is the lamp's backwards, and here one more.
	EXPECT_NEAR(HistogramMatcher().match(query, target).score, 2 / std::sqrt(2.0), 1e-6);
}

TEST(RandomWalkMatcher, TheOnlyWalkIsCommonToAll)
{
	SemanticGraph pair = complete({vertex(0, "lamp", 0, 0, 0), vertex(1, "chair", 1, 0, 0)});
	RandomWalkMatcher matcher;
	EXPECT_DOUBLE_EQ(matcher.match(pair, pair).score, 2);
	// With looks that are at right angles, half of it is left.
	auto other = pair;
	for (auto& v : pair.vertices) v.embeddings = {{1, 0}};
	for (auto& v : other.vertices) v.embeddings = {{0, 1}};
	EXPECT_DOUBLE_EQ(matcher.match(pair, other).score, 1);
}

TEST(DescriptorMatcher, UnknownKeysAreWrongUsage)
{
	mrpt::config::CConfigFileMemory config(std::string("[graph_matching]\nwalk = 3\n"));
	EXPECT_THROW(HistogramMatcher().configure(config, "graph_matching"), UsageError);
	EXPECT_THROW(RandomWalkMatcher().configure(config, "graph_matching"), UsageError);
}
}  // namespace
