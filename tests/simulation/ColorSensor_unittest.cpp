#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/ColorSensor.h>

#include "HandMadeView.h"

using namespace semloop;

namespace
{
RenderedView grayView(int width, int height, float value)
{
	RenderedView view = wallView(width, height, 2.0F);
	view.color = cv::Mat(height, width, CV_32FC3, cv::Scalar::all(value));
	return view;
}

ColorSensorOptions withoutNoise()
{
	ColorSensorOptions options;
	options.readNoise = options.shotNoise = 0;
	return options;
}

int firstGreen(const cv::Mat& image)
{
	return image.at<cv::Vec3b>(0, 0)[1];
}
}  // namespace

TEST(ColorSensor, LinearValuesAreEncodedAsSrgb)
{
	RenderedView view = grayView(1, 1, 0);
	view.color.at<cv::Vec3f>(0, 0) = {0.0F, 0.5F, 1.0F};
	const cv::Mat image = senseColor(view, withoutNoise(), 0, 1);
	// 255 (1.055 * 0.5^(1 / 2.4) - 0.055) = 187.5
	EXPECT_EQ(image.at<cv::Vec3b>(0, 0)[0], 0);
	EXPECT_NEAR(image.at<cv::Vec3b>(0, 0)[1], 188, 1);
	EXPECT_EQ(image.at<cv::Vec3b>(0, 0)[2], 255);
	// 0.001: the straight part, 255 * 12.92 * 0.001 = 3.3
	EXPECT_EQ(firstGreen(senseColor(grayView(1, 1, 0.001F), withoutNoise(), 0, 1)), 3);
}

TEST(ColorSensor, WhatIsTooBrightOrBelowZeroIsCut)
{
	EXPECT_EQ(firstGreen(senseColor(grayView(1, 1, 7.0F), withoutNoise(), 0, 1)), 255);
	EXPECT_EQ(firstGreen(senseColor(grayView(1, 1, -1.0F), withoutNoise(), 0, 1)), 0);
}

TEST(ColorSensor, TheExposureSwingsAboutOne)
{
	ColorSensorOptions options = withoutNoise();
	options.exposureDrift = 0.5;
	options.exposurePeriod = 4;
	const RenderedView view = grayView(1, 1, 0.4F);
	const auto plain = [](float value)
	{ return firstGreen(senseColor(grayView(1, 1, value), withoutNoise(), 0, 1)); };
	EXPECT_EQ(firstGreen(senseColor(view, options, 0, 1)), plain(0.4F));
	EXPECT_EQ(firstGreen(senseColor(view, options, 1, 1)), plain(0.6F));
	EXPECT_EQ(firstGreen(senseColor(view, options, 3, 1)), plain(0.2F));
}

TEST(ColorSensor, TheNoiseGrowsWithTheRootOfTheLight)
{
	for (const float light : {0.1F, 0.5F})
	{
		const cv::Mat image = senseColor(grayView(320, 240, light), {}, 0, 1);
		cv::Scalar mean, sigma;
		cv::meanStdDev(image, mean, sigma);
		// Rounding adds 1 / 12.
		const double expected = std::sqrt(1.5 * 1.5 + 2.5 * 2.5 * light + 1.0 / 12);
		for (int c = 0; c < 3; c++)
		{
			EXPECT_NEAR(sigma[c], expected, 0.02 * expected) << light;
			EXPECT_NEAR(mean[c], mean[0], 0.05);
		}
	}
}

TEST(ColorSensor, TheSeedDecidesTheImage)
{
	const RenderedView view = grayView(64, 48, 0.3F);
	EXPECT_TRUE(sameBytes(senseColor(view, {}, 1, 5), senseColor(view, {}, 1, 5)));
	EXPECT_FALSE(sameBytes(senseColor(view, {}, 1, 5), senseColor(view, {}, 1, 6)));
}

TEST(ColorSensor, AnEmptyViewGivesAnEmptyImageAndOneWithoutColourIsRejected)
{
	EXPECT_TRUE(senseColor({}, {}, 0, 1).empty());
	EXPECT_THROW(senseColor(wallView(4, 4, 2.0F), {}, 0, 1), InputError);
}
