#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/CliqueMatcher.h>

#include <cmath>
#include <random>

#include "GraphFixtures.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;

TEST(CliqueMatcher, MatchesWhatIsConsistentAndRefusesTheRest)
{
	for (unsigned seed = 0; seed < 10; ++seed)
	{
		const auto query = randomRoom(12, 6, seed);
		auto target = moved(query, yawPose(2, -1, 0.5, 1));
		// Three were moved: unlike the paper's matcher this one can leave them alone.
		for (const std::size_t moved : {2, 5, 7}) target.vertices[moved].position.y += 2.5;
		const auto matching = CliqueMatcher().match(query, target);
		EXPECT_GE(matching.matches.size(), 8u) << seed;
		for (const auto& match : matching.matches)
		{
			EXPECT_EQ(match.query, match.target) << seed;
			EXPECT_TRUE(match.query != 2 && match.query != 5 && match.query != 7) << seed;
		}
	}
}

TEST(CliqueMatcher, TheScoreOfACliqueIsItsSizeWhenAllDistancesAgree)
{
	const auto matching = CliqueMatcher().match(fourObjects(), fourObjects());
	EXPECT_EQ(matching.matches, identityMatches(4));
	// All four consistent: M is all ones, and u its eigenvector of the eigenvalue 4.
	EXPECT_NEAR(matching.score, 4, 1e-3);
}

TEST(CliqueMatcher, TheLargerOfTwoCliquesWins)
{
	// Of the three chairs two are where they were, one went; the lamp, table and cup decide which.
	auto query = complete(
		{vertex(0, "chair", 0, 0, 0), vertex(1, "lamp", 2, 0, 1), vertex(2, "table", 0, 3, 0)});
	auto target = query;
	target.vertices.push_back(vertex(3, "chair", 9, 0, 0));
	target.vertices.push_back(vertex(4, "lamp", 11, 0, 1));
	EXPECT_EQ(CliqueMatcher().match(query, target).matches, identityMatches(3));
}

TEST(CliqueMatcher, OfTwoEqualCopiesOneIsTakenWhole)
{
	const auto desk = randomRoom(7, 7, 5);
	const auto both = united(desk, moved(desk, yawPose(30, 0, 0, 0.5)));
	const auto matches = CliqueMatcher().match(desk, both).matches;
	ASSERT_EQ(matches.size(), 7u);
	for (const auto& match : matches) EXPECT_EQ(match.target < 7, matches[0].target < 7);
}

TEST(CliqueMatcher, HeightsAreHeldAgainstEachOther)
{
	// The distance is the same, up and across exchanged.
	const auto query = complete({vertex(0, "chair", 0, 0, 0), vertex(1, "lamp", 2, 0, 0)});
	const auto target = complete({vertex(0, "chair", 0, 0, 0), vertex(1, "lamp", 0, 0, 2)});
	EXPECT_EQ(CliqueMatcher().match(query, target).matches.size(), 1u);
}

TEST(CliqueMatcher, EmptyGraphsGiveNoMatches)
{
	EXPECT_TRUE(CliqueMatcher().match({}, fourObjects()).matches.empty());
	EXPECT_TRUE(CliqueMatcher().match(fourObjects(), {}).matches.empty());
}

TEST(CliqueMatcher, RefusesAProblemThatWouldNotFitInMemory)
{
	CliqueMatcher matcher;
	matcher.options.maxEntries = 10;
	EXPECT_THAT(
		messageOf<InputError>([&] { matcher.match(randomRoom(9, 2, 1), randomRoom(9, 2, 1)); }),
		testing::HasSubstr("raise max_entries"));
}
}  // namespace
