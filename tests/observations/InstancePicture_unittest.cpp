#include <gtest/gtest.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CTexturedPlane.h>
#include <semloop/config/Error.h>
#include <semloop/observations/InstancePicture.h>

#include <cstdlib>

#include "TwoInstances.h"

namespace
{
using namespace semloop;
using mrpt::opengl::CPointCloudColoured;
using mrpt::opengl::CTexturedPlane;

mrpt::opengl::CSetOfObjects visualization(const CObservationInstances& observation)
{
	mrpt::opengl::CSetOfObjects all;
	observation.getVisualizationInto(all);
	return all;
}

int difference(const mrpt::img::TColor& a, const mrpt::img::TColor& b)
{
	return std::abs(a.R - b.R) + std::abs(a.G - b.G) + std::abs(a.B - b.B);
}
}  // namespace

TEST(LabelColor, DependsOnTheNameAlone)
{
	EXPECT_EQ(labelColor("chair"), labelColor("chair"));
	EXPECT_GT(difference(labelColor("chair"), labelColor("cup")), 60);
	// Bright enough to be seen on the dark, coloured enough to be told from grey.
	const LabelSet labels = LabelSet::coco();
	for (const auto& name : labels.names())
	{
		const auto color = labelColor(name);
		EXPECT_EQ(std::max({color.R, color.G, color.B}), 235) << name;
		EXPECT_LT(std::min({color.R, color.G, color.B}), 0.4 * 235 + 1) << name;
	}
}

TEST(DrawInstances, MixesTheLabelsColourIntoTheMaskAndLeavesTheRest)
{
	const auto observation = twoInstances(1);
	const cv::Mat grey(48, 64, CV_8UC3, cv::Scalar::all(100));
	const cv::Mat picture = drawInstances(observation, grey);
	const auto color = labelColor("potted plant");
	const auto inside = picture.at<cv::Vec3b>(22, 12), edge = picture.at<cv::Vec3b>(20, 10);
	EXPECT_NEAR(inside[0], 0.45 * 100 + 0.55 * color.B, 1);
	EXPECT_NEAR(inside[2], 0.45 * 100 + 0.55 * color.R, 1);
	EXPECT_NEAR(edge[1], 0.6 * color.G, 1);
	EXPECT_EQ(picture.at<cv::Vec3b>(40, 50), cv::Vec3b(100, 100, 100));
	EXPECT_EQ(grey.at<cv::Vec3b>(22, 12), cv::Vec3b(100, 100, 100));  // the input stays
}

TEST(DrawInstances, SmallMasksLieOnLargeOnes)
{
	auto observation = twoInstances(1);
	auto& mug = observation.instances[1];
	mug.box = {12, 21, 3, 3};
	mug.mask = InstanceMask::encode(
		cv::Mat(3, 3, CV_8UC1, cv::Scalar(255)), mug.box.tl(), observation.imageSize());
	std::swap(observation.instances[0], observation.instances[1]);
	const auto edge = drawInstances(observation).at<cv::Vec3b>(21, 12);
	EXPECT_NEAR(edge[2], 0.6 * labelColor("mug").R, 1);
}

TEST(DrawInstances, AnImageOfAnotherSizeIsAnError)
{
	EXPECT_THROW(drawInstances(twoInstances(1), cv::Mat(48, 63, CV_8UC3)), InputError);
	EXPECT_THROW(drawInstances(twoInstances(1), cv::Mat(48, 64, CV_8UC1)), InputError);
}

TEST(InstancesVisualization, HasThePointsOfTheDepthCropsInTheRobotsFrame)
{
	auto observation = twoInstances(1);
	observation.sensorPose = mrpt::poses::CPose3D(0, 0, 1.5, 0, 0, 0);
	auto all = visualization(observation);
	const auto points = all.getByClass<CPointCloudColoured>();
	ASSERT_TRUE(points);
	ASSERT_EQ(points->size(), 48u);  // the plant's; the mug has no depth
	// Pixel (10, 20) at 2 m: forward 2, left -2 (10 - 31.5) / 52, up -2 (20 - 23.5) / 52.
	const auto point = points->getPoint3Df(0);
	const auto p_robot = points->getPose() + mrpt::math::TPoint3D(point.x, point.y, point.z);
	EXPECT_NEAR(p_robot.x, 2, 1e-6);
	EXPECT_NEAR(p_robot.y, 2 * 21.5 / 52, 1e-6);
	EXPECT_NEAR(p_robot.z, 1.5 + 2 * 3.5 / 52, 1e-6);
	const auto color = labelColor("potted plant");
	EXPECT_NEAR(points->getPointColor(0).R, color.R, 1);
}

TEST(InstancesVisualization, HasThePictureWhereTheCameraLooks)
{
	auto all = visualization(twoInstances(1));
	const auto screen = all.getByClass<CTexturedPlane>();
	ASSERT_TRUE(screen);
	EXPECT_EQ(screen->getTextureImage().getWidth(), 64u);
	float left = 0, right = 0, top = 0, bottom = 0;
	screen->getPlaneCorners(left, right, top, bottom);
	EXPECT_NEAR(left, -32.0 / 52, 1e-6);
	EXPECT_NEAR(right, 32.0 / 52, 1e-6);
	EXPECT_NEAR(top, -24.0 / 52, 1e-6);
	// The top left corner: 1 m ahead, to the left, above.
	const auto corner = screen->getPose() + mrpt::math::TPoint3D(left, top, 0);
	EXPECT_NEAR(corner.x, 1, 1e-6);
	EXPECT_NEAR(corner.y, 32.0 / 52, 1e-6);
	EXPECT_NEAR(corner.z, 24.0 / 52, 1e-6);
}

TEST(InstancesVisualization, OfNoCameraThereIsNone)
{
	CObservationInstances empty;
	empty.camera.ncols = empty.camera.nrows = 0;
	EXPECT_TRUE(visualization(empty).empty());
}
