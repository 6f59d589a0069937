#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/SpectralMatcher.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "GraphFixtures.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using testing::HasSubstr;

TEST(SpectralMatcher, MatchesAGraphToItself)
{
	const auto graph = fourObjects();
	const auto matching = SpectralMatcher().match(graph, graph);
	EXPECT_EQ(matching.matches, identityMatches(4));
	// 4 vertices and 6 edges in both orders, each with reward 1.
	EXPECT_NEAR(matching.score, 4 + 2 * 6, 1e-9);
}

TEST(SpectralMatcher, RewardFallsByEOverADifferenceOfOneByMu)
{
	// Edges of 2.0 and 2.3 m: 2 vertices + 2 exp(-5 * 0.3).
	const auto query = complete({vertex(0, "a", 0, 0, 0), vertex(1, "b", 2, 0, 0)});
	const auto target = complete({vertex(0, "a", 0, 0, 0), vertex(1, "b", 2.3, 0, 0)});
	SpectralMatcher matcher;
	matcher.options.mu = 5;
	EXPECT_NEAR(matcher.match(query, target).score, 2 + 2 * std::exp(-1.5), 1e-9);
}

TEST(SpectralMatcher, DistancesTellObjectsOfOneLabelApart)
{
	// Three chairs in a row, 1 m and 2 m apart; the target lists them backwards.
	const auto query = complete(
		{vertex(0, "chair", 0, 0, 0), vertex(1, "chair", 1, 0, 0), vertex(2, "chair", 3, 0, 0)});
	const auto target = reordered(query, {2, 1, 0});
	EXPECT_EQ(
		SpectralMatcher().match(query, target).matches,
		(std::vector<Match>{{0, 2}, {1, 1}, {2, 0}}));
}

TEST(SpectralMatcher, IgnoresPairsThatWereNotSeenTogether)
{
	// Without its edge to the cup, the second table explains less than the first.
	auto target = complete(
		{vertex(0, "table", 0, 0, 0), vertex(1, "cup", 1, 0, 0), vertex(2, "table", 2, 0, 0)});
	const auto query = complete({vertex(0, "table", 0, 0, 0), vertex(1, "cup", 1, 0, 0)});
	target.edges = {{1, 2}};
	EXPECT_EQ(SpectralMatcher().match(query, target).matches, (std::vector<Match>{{0, 2}, {1, 1}}));
	target.edges = {{0, 1}};
	EXPECT_EQ(SpectralMatcher().match(query, target).matches, (std::vector<Match>{{0, 0}, {1, 1}}));
}

TEST(SpectralMatcher, NeverMatchesDifferentLabels)
{
	auto query = fourObjects(), target = fourObjects();
	target.vertices[2].label = "vase";
	EXPECT_EQ(
		SpectralMatcher().match(query, target).matches,
		(std::vector<Match>{{0, 0}, {1, 1}, {3, 3}}));
	for (auto& v : target.vertices) v.label = "vase";
	const auto none = SpectralMatcher().match(query, target);
	EXPECT_TRUE(none.matches.empty());
	EXPECT_EQ(none.score, 0);
}

TEST(SpectralMatcher, EmptyGraphsGiveNoMatches)
{
	EXPECT_TRUE(SpectralMatcher().match({}, {}).matches.empty());
	EXPECT_TRUE(SpectralMatcher().match({}, fourObjects()).matches.empty());
	EXPECT_TRUE(SpectralMatcher().match(fourObjects(), {}).matches.empty());
}

TEST(SpectralMatcher, OneVertexIsMatchedByItsLabel)
{
	const auto cup = complete({vertex(0, "cup", 5, 5, 5)});
	const auto matching = SpectralMatcher().match(cup, fourObjects());
	EXPECT_EQ(matching.matches, (std::vector<Match>{{0, 2}}));
	EXPECT_DOUBLE_EQ(matching.score, 1);
	EXPECT_EQ(SpectralMatcher().match(fourObjects(), cup).matches, (std::vector<Match>{{2, 0}}));
}

TEST(SpectralMatcher, GraphsWithoutEdgesAreMatchedByLabelAlone)
{
	auto graph = randomRoom(12, 3, 5);
	graph.edges.clear();
	const auto matching = SpectralMatcher().match(graph, graph);
	EXPECT_EQ(matching.matches.size(), 12);
	for (const auto& [q, t] : matching.matches)
		EXPECT_EQ(graph.vertices[q].label, graph.vertices[t].label);
}

TEST(SpectralMatcher, EveryVertexIsMatchedAtMostOnce)
{
	const auto matching = SpectralMatcher().match(randomRoom(20, 4, 1), randomRoom(9, 4, 2));
	std::set<std::size_t> queries, targets;
	for (const auto& [q, t] : matching.matches)
	{
		EXPECT_TRUE(queries.insert(q).second);
		EXPECT_TRUE(targets.insert(t).second);
	}
	EXPECT_LE(matching.matches.size(), 9);
	EXPECT_GT(matching.matches.size(), 0);
}

TEST(SpectralMatcher, IsInvariantToRotationAndTranslation)
{
	const auto graph = randomRoom(15, 4, 3);
	const auto T = mrpt::poses::CPose3D::FromXYZYawPitchRoll(10, -20, 3, 2.1, 0.4, -0.3);
	const auto matching = SpectralMatcher().match(moved(graph, T), graph);
	EXPECT_EQ(matching.matches, identityMatches(15));
	EXPECT_NEAR(matching.score, 15 + 15 * 14, 1e-6);
}

TEST(SpectralMatcher, IsInvariantToTheOrderOfTheVertices)
{
	const auto graph = randomRoom(8, 2, 4);
	const std::vector<std::size_t> order = {5, 2, 7, 0, 1, 6, 3, 4};
	const auto matching = SpectralMatcher().match(reordered(graph, order), graph);
	ASSERT_EQ(matching.matches.size(), 8);
	for (const auto& [q, t] : matching.matches) EXPECT_EQ(t, order[q]);
}

TEST(SpectralMatcher, FindsTheLocalMapInALargerMap)
{
	const auto map = united(randomRoom(25, 5, 8), randomRoom(25, 5, 9));
	std::vector<GraphVertex> seen;
	for (const std::size_t i : {3, 9, 4, 20, 11, 7, 15})
		seen.push_back(randomRoom(25, 5, 9).vertices[i]);
	const auto local = complete(seen);
	const auto matching = SpectralMatcher().match(local, map);
	ASSERT_EQ(matching.matches.size(), 7);
	for (const auto& [q, t] : matching.matches)
		EXPECT_EQ(local.vertices[q].id + 1000, map.vertices[t].id);
}

/** The relaxed problem by an independent way: a dense S by the definition, all pairs, Eigen's solver.
 *  Empty when the largest eigenvalue is not simple. */
std::optional<Eigen::MatrixXd> densePrincipalVector(
	const SemanticGraph& query, const SemanticGraph& target, double mu)
{
	const auto M = query.vertices.size(), N = target.vertices.size();
	Eigen::MatrixXd S = Eigen::MatrixXd::Zero(M * N, M * N);
	const auto same = [&](std::size_t j, std::size_t k)
	{ return query.vertices[j].label == target.vertices[k].label; };
	for (std::size_t j = 0; j < M; ++j)
		for (std::size_t k = 0; k < N; ++k)
			for (std::size_t j2 = 0; j2 < M; ++j2)
				for (std::size_t k2 = 0; k2 < N; ++k2)
				{
					if (!same(j, k) || !same(j2, k2)) continue;
					if (j == j2 && k == k2) S(j * N + k, j * N + k) = 1;
					if (!query.hasEdge(j, j2) || !target.hasEdge(k, k2)) continue;
					S(j * N + k, j2 * N + k2) =
						std::exp(-mu * std::abs(query.distance(j, j2) - target.distance(k, k2)));
				}
	const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(S);
	const auto values = solver.eigenvalues().tail<2>();
	if (values[1] - values[0] < 1e-3) return {};
	const Eigen::VectorXd v = solver.eigenvectors().col(S.rows() - 1).cwiseAbs();
	return Eigen::MatrixXd(Eigen::Map<const Eigen::MatrixXd>(v.data(), N, M).transpose());
}

TEST(SpectralMatcher, AgreesWithADenseEigensolverOnRandomGraphs)
{
	int checked = 0;
	for (unsigned seed = 0; seed < 10; ++seed)
	{
		auto query = randomRoom(4, 2, seed), target = randomRoom(6, 2, seed + 100);
		target.edges.erase({0, 1});
		target.edges.erase({2, 5});
		const auto relaxed = densePrincipalVector(query, target, 5.0);
		if (!relaxed) continue;
		++checked;

		// Best assignment by enumeration of all ways to give each query a target or nobody.
		std::vector<int> best, current(4, -1);
		double most = -1;
		std::size_t mostMatched = 0;
		const std::function<void(std::size_t, double, std::size_t)> enumerate =
			[&](std::size_t j, double sum, std::size_t matched)
		{
			if (j == 4)
			{
				if (matched > mostMatched || (matched == mostMatched && sum > most))
					best = current, most = sum, mostMatched = matched;
				return;
			}
			enumerate(j + 1, sum, matched);
			for (int k = 0; k < 6; ++k)
			{
				if (query.vertices[j].label != target.vertices[k].label) continue;
				if (std::count(current.begin(), current.begin() + j, k)) continue;
				current[j] = k;
				enumerate(j + 1, sum + (*relaxed)(j, k), matched + 1);
				current[j] = -1;
			}
		};
		enumerate(0, 0, 0);

		std::vector<int> found(4, -1);
		for (const auto& [q, t] : SpectralMatcher().match(query, target).matches)
			found[q] = static_cast<int>(t);
		EXPECT_EQ(found, best) << "seed " << seed;
	}
	EXPECT_GE(checked, 8);
}

TEST(SpectralMatcher, TheSameInputGivesTheSameOutput)
{
	const auto query = randomRoom(20, 2, 6), target = randomRoom(30, 2, 7);
	const auto first = SpectralMatcher().match(query, target);
	const auto second = SpectralMatcher().match(query, target);
	EXPECT_EQ(first.matches, second.matches);
	EXPECT_EQ(first.score, second.score);
}

TEST(SpectralMatcher, RefusesAProblemThatWouldNotFitInMemory)
{
	SpectralMatcher matcher;
	matcher.options.maxEntries = 100;
	const auto room = randomRoom(20, 1, 1);
	EXPECT_THROW(matcher.match(room, room), InputError);
}

TEST(SpectralMatcher, ReadsItsOptions)
{
	mrpt::config::CConfigFileMemory config;
	config.write("graph_matching", "mu", 2.5);
	SpectralMatcher matcher;
	matcher.configure(config, "graph_matching");
	EXPECT_EQ(matcher.options.mu, 2.5);
	config.write("graph_matching", "mu", -1);
	EXPECT_THROW(matcher.configure(config, "graph_matching"), UsageError);
}

TEST(SpectralMatcher, IsMadeByName)
{
	mrpt::rtti::registerAllPendingClasses();
	const auto object = mrpt::rtti::classFactory("semloop::SpectralMatcher");
	EXPECT_TRUE(std::dynamic_pointer_cast<GraphMatcher>(object));
}

TEST(MatchedEdgeShare, CountsTheEdgesThatBothGraphsHaveAtOneLength)
{
	const auto query = fourObjects();  // 6 edges
	EXPECT_DOUBLE_EQ(matchedEdgeShare(query, query, identityMatches(4), 0.01), 1);
	EXPECT_DOUBLE_EQ(matchedEdgeShare(query, query, identityMatches(3), 0.01), 0.5);

	auto target = query;
	target.edges.erase({0, 1});
	EXPECT_DOUBLE_EQ(matchedEdgeShare(query, target, identityMatches(4), 0.01), 5.0 / 6);
	target = query;
	target.vertices[3].position.z += 5;  // its three edges grow by more than 2 m
	EXPECT_DOUBLE_EQ(matchedEdgeShare(query, target, identityMatches(4), 2), 0.5);
	EXPECT_DOUBLE_EQ(matchedEdgeShare(query, target, identityMatches(4), 10), 1);
}

TEST(MatchedEdgeShare, IsZeroWithoutEdgesOrMatches)
{
	EXPECT_EQ(matchedEdgeShare({}, {}, {}, 1), 0);
	EXPECT_EQ(matchedEdgeShare(fourObjects(), fourObjects(), {}, 1), 0);
}
}  // namespace
