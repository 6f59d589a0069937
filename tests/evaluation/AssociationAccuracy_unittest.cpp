#include <gtest/gtest.h>
#include <semloop/evaluation/AssociationAccuracy.h>

#include "EvaluationFixtures.h"

namespace semloop
{
namespace
{
using namespace fixtures;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(PairBoxes, NeedHalfOfTheUnionInCommon)
{
	// 10 x 10 boxes moved by 3: 70 of 130 pixels are common, 0.54; by 4: 60 of 140, 0.43.
	const std::vector<TrueBox> truth{{1, {0, 0, 10, 10}, 100}, {2, {50, 0, 10, 10}, 100}};
	EXPECT_EQ(
		pairBoxes(truth, {record(0, {54, 0, 10, 10}, 7), record(0, {3, 0, 10, 10}, 8)}),
		(Pairs{{0, 1}}));
}

TEST(PairBoxes, GiveEveryBoxToOneOnlyTheBetterOne)
{
	const std::vector<TrueBox> truth{{1, {0, 0, 10, 10}, 100}};
	EXPECT_EQ(
		pairBoxes(truth, {record(0, {2, 0, 10, 10}, 7), record(0, {1, 0, 10, 10}, 8)}),
		(Pairs{{0, 1}}));
	EXPECT_TRUE(pairBoxes({}, {record(0, slot(1), 7)}).empty());
	EXPECT_TRUE(pairBoxes(truth, {}).empty());
}

TEST(AssociationAccuracy, IsOneWhenEveryObjectKeepsItsId)
{
	const auto result =
		associationAccuracy({frameWith(0, {{1, 10}, {2, 20}}), frameWith(1, {{1, 10}, {2, 20}})});
	EXPECT_EQ(result.frames, 2u);
	EXPECT_EQ(result.trueBoxes, 4u);
	EXPECT_EQ(result.correct, 4u);
	EXPECT_EQ(result.accuracy, 1.0);
}

TEST(AssociationAccuracy, CountsTheLargestSumOfSharedBoxes)
{
	// Shared boxes: (1, 10): 3, (1, 20): 2, (2, 10): 2, (2, 20): 0. One to one, 3 + 0 < 2 + 2.
	const auto result = associationAccuracy(
		{frameWith(0, {{1, 10}}), frameWith(1, {{1, 10}}), frameWith(2, {{1, 10}}),
		 frameWith(3, {{1, 20}, {2, 10}}), frameWith(4, {{1, 20}, {2, 10}})});
	EXPECT_EQ(result.trueBoxes, 7u);
	EXPECT_EQ(result.correct, 4u);
	EXPECT_DOUBLE_EQ(*result.accuracy, 4.0 / 7);
	ASSERT_EQ(result.matches.size(), 2u);
	EXPECT_EQ(result.matches[0].truth, 1u);
	EXPECT_EQ(result.matches[0].estimate, 20u);
	EXPECT_EQ(result.matches[1].sharedBoxes, 2u);
}

TEST(AssociationAccuracy, AnObjectBuiltTwiceAndTwoObjectsMadeOneLoseTheSmallerPart)
{
	const auto twice = associationAccuracy(
		{frameWith(0, {{1, 10}}), frameWith(1, {{1, 10}}), frameWith(2, {{1, 11}})});
	EXPECT_EQ(twice.correct, 2u);
	const auto made = associationAccuracy(
		{frameWith(0, {{1, 10}}), frameWith(1, {{1, 10}}), frameWith(2, {{2, 10}})});
	EXPECT_EQ(made.correct, 2u);
}

TEST(AssociationAccuracy, TellsBoxesThatWereNeverDetectedFromWronglyAssociatedOnes)
{
	auto frame = frameWith(0, {{1, 10}});
	frame.truth.push_back({2, slot(2), 100});
	frame.estimate.push_back(record(0, slot(9), 20));  // nothing is there
	const auto result = associationAccuracy({frame});
	EXPECT_EQ(result.trueBoxes, 2u);
	EXPECT_EQ(result.detectedBoxes, 1u);
	EXPECT_EQ(result.accuracy, 0.5);
	EXPECT_EQ(result.accuracyOfDetected, 1.0);
}

TEST(AssociationAccuracy, SmallMasksDoNotCount)
{
	auto frame = frameWith(0, {{1, 10}, {2, 20}});
	frame.truth[1].pixels = 49;
	EXPECT_EQ(associationAccuracy({frame}, 49).trueBoxes, 2u);
	const auto result = associationAccuracy({frame}, 50);
	EXPECT_EQ(result.trueBoxes, 1u);
	EXPECT_EQ(result.correct, 1u);
}

TEST(AssociationAccuracy, OfNothingIsEmptyAndNotANumber)
{
	const auto result = associationAccuracy({RunFrame()});
	EXPECT_FALSE(result.accuracy);
	EXPECT_FALSE(result.accuracyOfDetected);
	EXPECT_TRUE(result.matches.empty());
}
}  // namespace
}  // namespace semloop
