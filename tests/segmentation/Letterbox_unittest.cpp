#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/Letterbox.h>

namespace
{
using semloop::InputError;
using semloop::Letterbox;

void expectSame(const cv::Rect2d& a, const cv::Rect2d& b)
{
	EXPECT_NEAR(a.x, b.x, 1e-12);
	EXPECT_NEAR(a.y, b.y, 1e-12);
	EXPECT_NEAR(a.width, b.width, 1e-12);
	EXPECT_NEAR(a.height, b.height, 1e-12);
}

TEST(Letterbox, LeavesAnImageOfTheNetworksSizeUntouched)
{
	const cv::Mat image(48, 64, CV_8UC3, cv::Scalar(1, 2, 3));
	const Letterbox letterbox(image.size(), {64, 48});
	EXPECT_EQ(letterbox.apply(image).data, image.data);
	expectSame(letterbox.toImage({3, 4, 5, 6}), {3, 4, 5, 6});
}

TEST(Letterbox, CentresAWideImageBetweenGreyBars)
{
	const cv::Mat image(50, 100, CV_8UC3, cv::Scalar(10, 20, 30));
	const cv::Mat input = Letterbox(image.size(), {40, 40}).apply(image);
	ASSERT_EQ(input.size(), cv::Size(40, 40));
	EXPECT_EQ(input.at<cv::Vec3b>(9, 20), cv::Vec3b(114, 114, 114));
	EXPECT_EQ(input.at<cv::Vec3b>(10, 20), cv::Vec3b(10, 20, 30));
	EXPECT_EQ(input.at<cv::Vec3b>(29, 20), cv::Vec3b(10, 20, 30));
	EXPECT_EQ(input.at<cv::Vec3b>(30, 20), cv::Vec3b(114, 114, 114));
}

TEST(Letterbox, TakesBoxesBackToTheImage)
{
	// 100 x 50 into 40 x 40: scale 0.4, 10 pixels of grey above.
	const Letterbox letterbox({100, 50}, {40, 40});
	expectSame(letterbox.toImage({0, 10, 40, 20}), {0, 0, 100, 50});
	expectSame(letterbox.toImage({4, 12, 8, 4}), {10, 5, 20, 10});
}

TEST(Letterbox, EnlargesASmallImage)
{
	const Letterbox letterbox({20, 40}, {80, 80});
	expectSame(letterbox.toImage({20, 0, 40, 80}), {0, 0, 20, 40});
}

TEST(Letterbox, RefusesEmptySizesAndOtherImages)
{
	EXPECT_THROW(Letterbox({0, 10}, {40, 40}), InputError);
	EXPECT_THROW(Letterbox({10, 10}, {40, 0}), InputError);
	EXPECT_THROW(Letterbox({10, 10}, {40, 40}).apply(cv::Mat(11, 10, CV_8UC3)), InputError);
}

}  // namespace
