#include <gtest/gtest.h>
#include <semloop/segmentation/Detection.h>

#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

Candidate candidate(const cv::Rect2d& box, uint32_t label, float score, int index)
{
	return {box, {{label, score}}, index};
}

std::vector<int> indices(const std::vector<Candidate>& candidates)
{
	std::vector<int> result;
	for (const auto& c : candidates) result.push_back(c.index);
	return result;
}

TEST(Detection, IntersectionOverUnionOfTwoOverlappingSquares)
{
	EXPECT_DOUBLE_EQ(intersectionOverUnion({0, 0, 2, 2}, {1, 0, 2, 2}), 2.0 / 6.0);
	EXPECT_DOUBLE_EQ(intersectionOverUnion({0, 0, 2, 2}, {5, 0, 2, 2}), 0.0);
	EXPECT_DOUBLE_EQ(intersectionOverUnion({0, 0, 0, 0}, {0, 0, 0, 0}), 0.0);
}

TEST(Detection, SuppressionKeepsTheStrongerOfTwoOverlappingBoxesOfOneLabel)
{
	const auto kept = suppressNonMaxima(
		{candidate({0, 0, 10, 10}, 1, 0.5f, 0), candidate({1, 0, 10, 10}, 1, 0.9f, 1)}, {});
	EXPECT_EQ(indices(kept), std::vector<int>({1}));
}

TEST(Detection, SuppressionLeavesOtherLabelsAlone)
{
	const auto kept = suppressNonMaxima(
		{candidate({0, 0, 10, 10}, 1, 0.5f, 0), candidate({0, 0, 10, 10}, 2, 0.9f, 1)}, {});
	EXPECT_EQ(indices(kept), std::vector<int>({1, 0}));
}

TEST(Detection, ABoxThatWasSuppressedSuppressesNothing)
{
	// 0 removes 1; 2 overlaps only 1.
	DetectionLimits limits;
	limits.maxIou = 0.3;
	const auto kept = suppressNonMaxima(
		{candidate({0, 0, 10, 10}, 1, 0.9f, 0), candidate({5, 0, 10, 10}, 1, 0.8f, 1),
		 candidate({10, 0, 10, 10}, 1, 0.7f, 2)},
		limits);
	EXPECT_EQ(indices(kept), std::vector<int>({0, 2}));
}

TEST(Detection, SuppressionStopsAtTheGreatestNumberAndKeepsTheOrderOfTies)
{
	DetectionLimits limits;
	limits.maxDetections = 2;
	const auto kept = suppressNonMaxima(
		{candidate({0, 0, 1, 1}, 1, 0.5f, 0), candidate({5, 0, 1, 1}, 1, 0.5f, 1),
		 candidate({9, 0, 1, 1}, 1, 0.5f, 2)},
		limits);
	EXPECT_EQ(indices(kept), std::vector<int>({0, 1}));
	EXPECT_TRUE(suppressNonMaxima({}, limits).empty());
}

TEST(Detection, PixelBoxRoundsAndStaysInsideTheImage)
{
	EXPECT_EQ(pixelBox({1.4, 1.6, 2, 2}, {10, 10}), cv::Rect(1, 2, 2, 2));
	EXPECT_EQ(pixelBox({-5, -5, 8, 30}, {10, 12}), cv::Rect(0, 0, 3, 12));
	EXPECT_TRUE(pixelBox({20, 0, 5, 5}, {10, 10}).empty());
	EXPECT_TRUE(pixelBox({1e12, 0, 5, 5}, {10, 10}).empty());
}

TEST(Detection, AMaskFromAGridOfTheImagesOwnSizeIsTheThresholdedGrid)
{
	const cv::Mat grid = (cv::Mat_<float>(2, 3) << -1, 1, -1, 2, -2, 2);
	const cv::Mat mask = maskFromGrid(grid, {0, 0, 3, 2}, {0, 0, 3, 2}, 0.0f);
	const cv::Mat expected = (cv::Mat_<uint8_t>(2, 3) << 0, 255, 0, 255, 0, 255);
	EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0);
}

TEST(Detection, AGridIsInterpolatedBetweenTheCentresOfItsCells)
{
	// Cells of 4 pixels with centres at 2 and 6: the value is x - 2, clamped to [0, 4].
	const cv::Mat grid = (cv::Mat_<float>(1, 2) << 0, 4);
	const cv::Mat mask = maskFromGrid(grid, {0, 0, 8, 1}, {0, 0, 8, 1}, 0.9f);
	const cv::Mat expected = (cv::Mat_<uint8_t>(1, 8) << 0, 0, 0, 255, 255, 255, 255, 255);
	EXPECT_EQ(cv::norm(mask, expected, cv::NORM_INF), 0);
}

TEST(Detection, AMaskOfAPartIsThatPartOfTheWholeMask)
{
	cv::Mat grid(6, 7, CV_32F);
	cv::theRNG().state = 5;
	cv::randu(grid, -1, 1);
	const cv::Rect2d extent(-3.3, 2.1, 50, 40);
	const cv::Mat whole = maskFromGrid(grid, extent, {0, 0, 60, 50}, 0.0f);
	const cv::Rect part(11, 7, 23, 31);
	EXPECT_EQ(cv::norm(whole(part), maskFromGrid(grid, extent, part, 0.0f), cv::NORM_INF), 0);
}

}  // namespace
