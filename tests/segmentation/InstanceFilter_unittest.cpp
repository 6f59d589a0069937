#include <gtest/gtest.h>
#include <semloop/segmentation/InstanceFilter.h>

#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

const cv::Size kImage(40, 30);
const LabelMapping kMapping = {0u, 1u, std::nullopt, 2u, 3u, 4u, 5u, 6u};

Detection solid(const cv::Rect& box, const LabelScores& scores)
{
	return {box, cv::Mat(box.size(), CV_8UC1, cv::Scalar(255)), scores};
}

TEST(InstanceFilter, GivesNothingForNothing)
{
	EXPECT_TRUE(filterInstances({}, kImage, kMapping, {}).empty());
}

TEST(InstanceFilter, ScoresSumUpToOneAndTheConfidenceIsTheBestBefore)
{
	const auto instances =
		filterInstances({solid({1, 2, 5, 4}, {{1, 0.6f}, {0, 0.2f}})}, kImage, kMapping, {});
	ASSERT_EQ(instances.size(), 1u);
	EXPECT_FLOAT_EQ(instances[0].confidence, 0.6f);
	ASSERT_EQ(instances[0].labelScores.size(), 2u);
	EXPECT_FLOAT_EQ(instances[0].labelScores[0].score, 0.75f);
	EXPECT_FLOAT_EQ(instances[0].labelScores[1].score, 0.25f);
}

TEST(InstanceFilter, KeepsAtMostFiveLabels)
{
	const auto instances = filterInstances(
		{solid({1, 2, 5, 4}, {{0, 0.5f}, {1, 0.1f}, {3, 0.1f}, {4, 0.1f}, {5, 0.1f}, {6, 0.1f}})},
		kImage, kMapping, {});
	EXPECT_EQ(instances.at(0).labelScores.size(), 5u);
}

TEST(InstanceFilter, MapsLabelsAndDropsThoseThatAreNotInTheSet)
{
	const auto instances = filterInstances(
		{solid({1, 2, 5, 4}, {{3, 0.6f}, {2, 0.2f}}), solid({20, 2, 5, 4}, {{2, 0.6f}, {3, 0.2f}}),
		 solid({30, 2, 5, 4}, {{99, 0.6f}})},
		kImage, kMapping, {});
	ASSERT_EQ(instances.size(), 1u);
	EXPECT_EQ(instances[0].label(), 2u);
	EXPECT_FLOAT_EQ(instances[0].labelScores[0].score, 1.0f);
}

TEST(InstanceFilter, TheBoxIsThatOfTheMask)
{
	auto detection = solid({5, 5, 10, 10}, {{0, 0.9f}});
	detection.mask.colRange(0, 4).setTo(0);
	const auto instances = filterInstances({detection}, kImage, kMapping, {});
	EXPECT_EQ(instances.at(0).box, cv::Rect(9, 5, 6, 10));
	EXPECT_EQ(instances.at(0).mask.imageSize(), kImage);
	EXPECT_EQ(instances.at(0).mask.area(), 60u);
}

TEST(InstanceFilter, DropsSmallAndEmptyMasks)
{
	InstanceLimits limits;
	limits.minArea = 20;
	const Detection empty{{5, 5, 10, 10}, cv::Mat::zeros(10, 10, CV_8UC1), {{0, 0.9f}}};
	const auto instances = filterInstances(
		{solid({0, 0, 19, 1}, {{0, 0.9f}}), solid({0, 5, 20, 1}, {{0, 0.9f}}), empty}, kImage,
		kMapping, limits);
	ASSERT_EQ(instances.size(), 1u);
	EXPECT_EQ(instances[0].box, cv::Rect(0, 5, 20, 1));
}

TEST(InstanceFilter, JoinsTwoLabelsOfOneObject)
{
	InstanceLimits limits;
	limits.duplicateIou = 0.7;
	const auto instances = filterInstances(
		{solid({0, 0, 10, 10}, {{0, 0.6f}, {1, 0.1f}}), solid({0, 0, 10, 9}, {{1, 0.4f}})}, kImage,
		kMapping, limits);
	ASSERT_EQ(instances.size(), 1u);
	EXPECT_EQ(instances[0].mask.area(), 100u);
	ASSERT_EQ(instances[0].labelScores.size(), 2u);
	EXPECT_FLOAT_EQ(instances[0].labelScores[0].score, 0.6f);
	EXPECT_FLOAT_EQ(instances[0].labelScores[1].score, 0.4f);
}

TEST(InstanceFilter, KeepsAnObjectInsideAnother)
{
	InstanceLimits limits;
	limits.duplicateIou = 0.7;
	const auto instances = filterInstances(
		{solid({0, 0, 10, 10}, {{0, 0.6f}}), solid({2, 2, 6, 6}, {{1, 0.4f}})}, kImage, kMapping,
		limits);
	EXPECT_EQ(instances.size(), 2u);
}

TEST(InstanceFilter, RemovesSpecksButKeepsThePartsOfAnOccludedObject)
{
	cv::Mat mask = cv::Mat::zeros(20, 40, CV_8UC1);
	mask(cv::Rect(0, 0, 10, 10)).setTo(255);
	mask(cv::Rect(20, 0, 10, 5)).setTo(255);
	mask(cv::Rect(36, 15, 3, 3)).setTo(255);
	const cv::Mat cleaned = withoutSmallParts(mask, 0.1);
	EXPECT_EQ(cv::countNonZero(cleaned), 150);
	EXPECT_EQ(cleaned.at<uint8_t>(16, 37), 0);
	EXPECT_EQ(cv::countNonZero(withoutSmallParts(mask, 0.0)), 159);
}

}  // namespace
