#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/InstanceMask.h>

#include <opencv2/core.hpp>
#include <random>

using semloop::difference;
using semloop::InputError;
using semloop::InstanceMask;
using semloop::intersectionArea;
using semloop::intersectionOverUnion;
using Runs = std::vector<InstanceMask::Run>;

namespace
{
/** Random spans: density from nearly empty to nearly full, so that runs touch borders and merge. */
cv::Mat randomMask(std::mt19937& random, cv::Size size)
{
	const int percent = std::uniform_int_distribution<int>(0, 100)(random);
	std::uniform_int_distribution<int> roll(0, 99), keep(0, 3);
	cv::Mat mask(size, CV_8UC1);
	uint8_t value = 0;
	for (int y = 0; y < size.height; y++)
		for (int x = 0; x < size.width; x++)
		{
			if (keep(random) == 0) value = roll(random) < percent ? 255 : 0;
			mask.at<uint8_t>(y, x) = value;
		}
	return mask;
}

bool same(const cv::Mat& a, const cv::Mat& b)
{
	return a.size() == b.size() && (a.empty() || cv::countNonZero(a != b) == 0);
}

}  // namespace

TEST(InstanceMask, CodesSpansRowByRow)
{
	const cv::Mat mask =
		(cv::Mat_<uint8_t>(3, 5) << 0, 7, 7, 0, 1,  //
		 0, 0, 0, 0, 0,                             //
		 9, 9, 9, 9, 9);
	const auto coded = InstanceMask::encode(mask);
	EXPECT_EQ(coded.runs(), (Runs{{0, 1, 3}, {0, 4, 5}, {2, 0, 5}}));
	EXPECT_EQ(coded.area(), 8u);
	EXPECT_EQ(coded.boundingBox(), cv::Rect(0, 0, 5, 3));
	EXPECT_EQ(coded.imageSize(), cv::Size(5, 3));
}

TEST(InstanceMask, DecodesWhatItCodedOnRandomMasks)
{
	std::mt19937 random(1);
	for (int i = 0; i < 200; i++)
	{
		const cv::Mat mask = randomMask(random, {1 + i % 37, 1 + i % 23});
		const auto coded = InstanceMask::encode(mask);
		ASSERT_TRUE(same(coded.decode(), mask));
		ASSERT_EQ(coded.area(), std::size_t(cv::countNonZero(mask)));
		ASSERT_EQ(coded, InstanceMask(mask.size(), coded.runs()));  // the invariant holds
	}
}

TEST(InstanceMask, BoundingBoxIsTightOnRandomMasks)
{
	std::mt19937 random(2);
	for (int i = 0; i < 100; i++)
	{
		const cv::Mat mask = randomMask(random, {20, 11});
		const cv::Rect box = InstanceMask::encode(mask).boundingBox();
		const cv::Mat inBox = box.empty() ? cv::Mat() : cv::Mat(mask(box));
		ASSERT_EQ(box.empty() ? 0 : cv::countNonZero(inBox), cv::countNonZero(mask));
		if (box.empty()) continue;
		for (const auto& edge :
			 {inBox.row(0), inBox.row(box.height - 1), inBox.col(0), inBox.col(box.width - 1)})
			ASSERT_GT(cv::countNonZero(edge), 0);
	}
}

TEST(InstanceMask, CutsOffWhatFallsOutsideTheImage)
{
	const cv::Mat patch(4, 4, CV_8UC1, cv::Scalar(255));
	const auto topLeft = InstanceMask::encode(patch, {-2, -3}, {10, 8});
	EXPECT_EQ(topLeft.runs(), (Runs{{0, 0, 2}}));
	const auto bottomRight = InstanceMask::encode(patch, {9, 6}, {10, 8});
	EXPECT_EQ(bottomRight.runs(), (Runs{{6, 9, 10}, {7, 9, 10}}));
	EXPECT_TRUE(InstanceMask::encode(patch, {10, 0}, {10, 8}).empty());
	EXPECT_TRUE(InstanceMask::encode(patch, {-4, 0}, {10, 8}).empty());
}

TEST(InstanceMask, CodesAPartOfALargerMatrix)
{
	cv::Mat large(10, 10, CV_8UC1, cv::Scalar(0));
	large(cv::Rect(3, 3, 2, 2)) = 1;
	const auto coded = InstanceMask::encode(large(cv::Rect(2, 2, 4, 4)), {2, 2}, {10, 10});
	EXPECT_TRUE(same(coded.decode(), large * 255));
}

TEST(InstanceMask, DecodesOnlyTheBoxAskedFor)
{
	std::mt19937 random(3);
	const cv::Mat mask = randomMask(random, {30, 20});
	const auto coded = InstanceMask::encode(mask);
	EXPECT_TRUE(same(coded.decode({5, 4, 11, 9}), mask(cv::Rect(5, 4, 11, 9))));
	EXPECT_TRUE(same(coded.decode({-5, -4, 11, 9}), mask(cv::Rect(0, 0, 6, 5))));
	EXPECT_TRUE(coded.decode({30, 0, 5, 5}).empty());
}

TEST(InstanceMask, ContainsExactlyTheSetPixels)
{
	std::mt19937 random(4);
	const cv::Mat mask = randomMask(random, {17, 9});
	const auto coded = InstanceMask::encode(mask);
	for (int y = -1; y <= 9; y++)
		for (int x = -1; x <= 17; x++)
		{
			const bool inside = x >= 0 && y >= 0 && x < 17 && y < 9;
			ASSERT_EQ(coded.contains(x, y), inside && mask.at<uint8_t>(y, x) > 0) << x << "," << y;
		}
}

TEST(InstanceMask, SetOperationsAgreeWithDecodedMasks)
{
	std::mt19937 random(5);
	for (int i = 0; i < 300; i++)
	{
		const cv::Size size(1 + i % 41, 1 + i % 19);
		const cv::Mat a = randomMask(random, size), b = randomMask(random, size);
		const auto codedA = InstanceMask::encode(a), codedB = InstanceMask::encode(b);

		const int common = cv::countNonZero(a & b), together = cv::countNonZero(a | b);
		ASSERT_EQ(intersectionArea(codedA, codedB), std::size_t(common));
		ASSERT_EQ(intersectionArea(codedB, codedA), std::size_t(common));
		ASSERT_DOUBLE_EQ(
			intersectionOverUnion(codedA, codedB), together ? double(common) / together : 0.0);
		ASSERT_EQ(difference(codedA, codedB), InstanceMask::encode(a & ~b));
	}
}

TEST(InstanceMask, AMaskCoversItselfEntirely)
{
	std::mt19937 random(6);
	const auto mask = InstanceMask::encode(randomMask(random, {50, 40}));
	EXPECT_EQ(intersectionArea(mask, mask), mask.area());
	EXPECT_EQ(intersectionOverUnion(mask, mask), 1.0);
	EXPECT_TRUE(difference(mask, mask).empty());
	EXPECT_EQ(difference(mask, InstanceMask({50, 40})), mask);
}

TEST(InstanceMask, EmptyMasksHaveNothingInCommon)
{
	const InstanceMask none;
	EXPECT_EQ(none.area(), 0u);
	EXPECT_TRUE(none.boundingBox().empty());
	EXPECT_FALSE(none.contains(0, 0));
	EXPECT_TRUE(none.decode().empty());
	EXPECT_EQ(intersectionOverUnion(none, none), 0.0);
	EXPECT_TRUE(InstanceMask::encode(cv::Mat()).empty());
	EXPECT_EQ(cv::countNonZero(InstanceMask({4, 3}).decode()), 0);
}

TEST(InstanceMask, RefusesMasksOfDifferentImages)
{
	const InstanceMask a({10, 8}), b({8, 10});
	EXPECT_THROW(intersectionArea(a, b), InputError);
	EXPECT_THROW(intersectionOverUnion(a, b), InputError);
	EXPECT_THROW(difference(a, b), InputError);
}

TEST(InstanceMask, RefusesRunsThatBreakTheInvariant)
{
	const auto make = [](Runs runs) { return InstanceMask({10, 5}, std::move(runs)); };
	EXPECT_NO_THROW(make({{0, 0, 3}, {0, 4, 10}, {4, 0, 1}}));
	EXPECT_THROW(make({{0, 3, 3}}), InputError);             // empty
	EXPECT_THROW(make({{0, 4, 3}}), InputError);             // backwards
	EXPECT_THROW(make({{0, 0, 11}}), InputError);            // beyond the right border
	EXPECT_THROW(make({{5, 0, 1}}), InputError);             // below the image
	EXPECT_THROW(make({{0, 0, 3}, {0, 3, 5}}), InputError);  // touching
	EXPECT_THROW(make({{0, 0, 3}, {0, 2, 5}}), InputError);  // overlapping
	EXPECT_THROW(make({{1, 0, 3}, {0, 0, 3}}), InputError);  // rows out of order
	EXPECT_THROW(InstanceMask({65536, 1}), InputError);
	EXPECT_THROW(InstanceMask({-1, 1}), InputError);
	EXPECT_THROW(InstanceMask::encode(cv::Mat(2, 2, CV_32FC1, cv::Scalar(1))), InputError);
}

TEST(InstanceMask, ReachesTheLargestImageThatRunsCanHold)
{
	const cv::Mat row(1, 65535, CV_8UC1, cv::Scalar(1));
	EXPECT_EQ(InstanceMask::encode(row).area(), 65535u);
}
