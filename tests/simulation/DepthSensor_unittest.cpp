#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/DepthSensor.h>

#include <array>
#include <set>

#include "HandMadeView.h"

using namespace semloop;

namespace
{
/** Exact places, exact disparities: only the rounding is left. */
DepthSensorOptions withoutRandomness()
{
	DepthSensorOptions options;
	options.lateralSigma = 0;
	options.disparitySigma = 0;
	return options;
}

/** Depth that grows by this much a pixel [m], from 1 m on, sensed with disparities as fine as the options
 *  allow: K = 1024 * 500 * 0.075 = 38400, so that its steps are below 0.7 mm up to 5 m. Moments of the
 *  error, 5 pixels away from the border, where places would be cut off. */
struct RampError
{
	double mean = 0, variance = 0;  // [mm], [mm^2]
};

RampError errorOnRamp(float alongRow, float alongColumn, double lateralSigma)
{
	constexpr int kSize = 200, kBorder = 5;
	RenderedView view = wallView(kSize, kSize, 1.0F);
	for (int y = 0; y < kSize; y++)
		for (int x = 0; x < kSize; x++)
			view.depth.at<float>(y, x) += alongRow * float(x) + alongColumn * float(y);
	DepthSensorOptions options = withoutRandomness();
	options.disparityScale = 1024;
	options.lateralSigma = lateralSigma;
	const cv::Mat depth = senseDepth(view, options, 1);
	cv::Mat error;
	depth.convertTo(error, CV_64F);
	cv::subtract(error, view.depth * 1000, error, cv::noArray(), CV_64F);
	const cv::Range inside(kBorder, kSize - kBorder);
	cv::Scalar mean, sigma;
	cv::meanStdDev(error(inside, inside), mean, sigma);
	return {mean[0], sigma[0] * sigma[0]};
}

/** Columns of the first row without depth. */
std::set<int> invalidColumns(const cv::Mat& depth)
{
	std::set<int> columns;
	for (int x = 0; x < depth.cols; x++)
		if (depth.at<uint16_t>(0, x) == 0) columns.insert(x);
	return columns;
}

std::set<int> range(int begin, int end)
{
	std::set<int> numbers;
	for (int i = begin; i < end; i++) numbers.insert(i);
	return numbers;
}
}  // namespace

TEST(DepthSensor, AWallAtTwoMetresIsMeasuredWithinFiveMillimetres)
{
	// From 1.9 to 2.1 m, so that all phases of the rounding occur.
	RenderedView view = wallView(640, 480, 2.0F);
	for (int y = 0; y < 480; y++) view.depth.row(y) = 1.9F + 0.2F * float(y) / 480;
	const cv::Mat depth = senseDepth(view, {}, 1);
	double squares = 0;
	for (int y = 0; y < 480; y++)
		for (int x = 0; x < 640; x++)
			squares += std::pow(depth.at<uint16_t>(y, x) / 1000.0 - view.depth.at<float>(y, x), 2);
	const double rms = std::sqrt(squares / (640 * 480));
	// K = 8 * 500 * 0.075 = 300: z^2 / K * sqrt(1 / 12 + 1 / 36) = 4 / 300 / 3.
	EXPECT_NEAR(rms, 0.00444, 0.0002);
}

TEST(DepthSensor, OnlyWholeStepsOfDisparityAreMeasured)
{
	std::set<int> steps{0};
	for (int k = 1; k < 1000; k++) steps.insert(int(1000 * 300.0 / k + 0.5));
	RenderedView view = wallView(200, 100, 2.0F);
	for (int x = 0; x < 200; x++) view.depth.col(x) = 1.0F + 0.02F * float(x);
	const cv::Mat depth = senseDepth(view, {}, 1);
	for (int y = 0; y < 100; y++)
		for (int x = 0; x < 200; x++)
			ASSERT_TRUE(steps.count(depth.at<uint16_t>(y, x))) << depth.at<uint16_t>(y, x);
}

TEST(DepthSensor, TheLateralNoiseMakesAnErrorOfSlopeTimesSigmaAlongBothAxes)
{
	for (const double sigma : {0.5, 1.0})
	{
		// 10 mm a pixel, and 1 / 12 by rounding to millimetres; 36100 pixels: within 1 %.
		const double expected = 100 * sigma * sigma + 1.0 / 12;
		const std::array ramps{
			errorOnRamp(0.01F, 0, sigma), errorOnRamp(0, 0.01F, sigma),
			errorOnRamp(0.01F, 0.01F, sigma)};
		EXPECT_NEAR(ramps[0].variance, expected, 0.04 * expected) << sigma;
		EXPECT_NEAR(ramps[1].variance, expected, 0.04 * expected) << sigma;
		EXPECT_NEAR(ramps[2].variance, 2 * expected, 0.08 * expected) << "the axes are independent";
		for (const auto& ramp : ramps) EXPECT_NEAR(ramp.mean, 0, 0.3) << sigma;
	}
}

TEST(DepthSensor, WithoutLateralNoiseARampHasNoneOfIt)
{
	// Rounding to millimetres and to steps of at most 0.7 mm: less than (1 + 0.7^2) / 12.
	EXPECT_LT(errorOnRamp(0.01F, 0.01F, 0).variance, 0.13);
}

TEST(DepthSensor, AStepLeavesAShadowOnItsLeftAsWideAsTheDisparitiesDiffer)
{
	RenderedView view = wallView(200, 1, 3.0F);
	view.depth.colRange(100, 200) = 1.0F;
	// 37.5 (1 / 1 - 1 / 3) = 25 pixels.
	EXPECT_EQ(invalidColumns(senseDepth(view, withoutRandomness(), 1)), range(75, 100));
}

TEST(DepthSensor, AStepToTheFarSideLeavesNoShadow)
{
	RenderedView view = wallView(200, 1, 3.0F);
	view.depth.colRange(0, 100) = 1.0F;
	EXPECT_TRUE(invalidColumns(senseDepth(view, withoutRandomness(), 1)).empty());
}

TEST(DepthSensor, ThePoleHidesOnlyItsOwnWidthFromTheProjector)
{
	RenderedView view = wallView(200, 1, 3.0F);
	view.depth.colRange(100, 105) = 1.0F;
	// The pole is at 62.5 to 66.5 in the projector, where the wall behind has 12.5 more.
	EXPECT_EQ(invalidColumns(senseDepth(view, withoutRandomness(), 1)), range(75, 80));
}

TEST(DepthSensor, ASlantedSurfaceThrowsNoShadowOnItself)
{
	RenderedView view = wallView(200, 1, 1.0F);
	for (const float slope : {-0.01F, -0.003F, 0.003F, 0.01F})
	{
		for (int x = 0; x < 200; x++) view.depth.at<float>(0, x) = 3.0F + slope * float(x);
		EXPECT_TRUE(invalidColumns(senseDepth(view, withoutRandomness(), 1)).empty()) << slope;
	}
}

TEST(DepthSensor, NothingBetweenTheSidesOfAStepIsMeasured)
{
	RenderedView view = wallView(200, 100, 3.0F);
	view.depth.colRange(0, 100) = 1.0F;
	const cv::Mat depth = senseDepth(view, {}, 1);
	for (int y = 0; y < 100; y++)
		for (int x = 95; x < 105; x++)
		{
			const int z = depth.at<uint16_t>(y, x);
			EXPECT_TRUE(std::abs(z - 1000) < 10 || std::abs(z - 3000) < 80) << x << " " << z;
		}
}

TEST(DepthSensor, WhatIsSeenTooFlatIsNotMeasured)
{
	RenderedView view = wallView(40, 1, 2.0F);
	view.cosine.colRange(10, 20) = 0.15F;
	view.cosine.colRange(20, 30) = 0.17F;
	EXPECT_EQ(invalidColumns(senseDepth(view, withoutRandomness(), 1)), range(10, 20));
}

TEST(DepthSensor, OnlyTheRangeIsMeasured)
{
	for (const bool noise : {false, true})
	{
		DepthSensorOptions options = withoutRandomness();
		options.noise = noise;
		for (const float outside : {0.0F, 0.44F, 6.01F, 60.0F, 600.0F})
			EXPECT_EQ(cv::countNonZero(senseDepth(wallView(9, 9, outside), options, 1)), 0)
				<< outside;
		for (const float inside : {0.46F, 5.99F})
			EXPECT_EQ(cv::countNonZero(senseDepth(wallView(9, 9, inside), options, 1)), 81)
				<< inside;
	}
}

TEST(DepthSensor, WithoutNoiseTheDepthIsRoundedToMillimetres)
{
	DepthSensorOptions options;
	options.noise = false;
	RenderedView view = wallView(4, 1, 1.2344F);
	view.cosine = cv::Scalar(0.01);
	view.depth.at<float>(0, 3) = 1.2346F;
	const cv::Mat depth = senseDepth(view, options, 1);
	EXPECT_EQ(depth.at<uint16_t>(0, 0), 1234);
	EXPECT_EQ(depth.at<uint16_t>(0, 3), 1235);
}

TEST(DepthSensor, TheSeedDecidesTheImage)
{
	const RenderedView view = wallView(64, 48, 2.0F);
	EXPECT_TRUE(sameBytes(senseDepth(view, {}, 5), senseDepth(view, {}, 5)));
	EXPECT_FALSE(sameBytes(senseDepth(view, {}, 5), senseDepth(view, {}, 6)));
}

TEST(DepthSensor, AnEmptyViewGivesAnEmptyImage)
{
	EXPECT_TRUE(senseDepth({}, {}, 1).empty());
}

TEST(DepthSensor, ViewsThatItCannotSenseAreRejected)
{
	RenderedView view = wallView(4, 4, 2.0F);
	view.cosine = cv::Mat(3, 4, CV_32FC1, cv::Scalar(1));
	EXPECT_THROW(senseDepth(view, {}, 1), InputError);
	view = wallView(4, 4, 2.0F);
	view.depth.convertTo(view.depth, CV_64F);
	EXPECT_THROW(senseDepth(view, {}, 1), InputError);
	DepthSensorOptions options;
	options.minimumRange = 7;
	EXPECT_THROW(senseDepth(wallView(4, 4, 2.0F), options, 1), UsageError);
}
