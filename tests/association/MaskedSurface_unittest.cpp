#include <gtest/gtest.h>
#include <semloop/association/MaskedSurface.h>
#include <semloop/config/Error.h>

#include <cmath>

using namespace semloop;

namespace
{
const cv::Size kImage(320, 240);

mrpt::img::TCamera camera()
{
	mrpt::img::TCamera camera;
	camera.ncols = kImage.width;
	camera.nrows = kImage.height;
	camera.setIntrinsicParamsFromValues(250, 250, 160, 120);
	return camera;
}

cv::Mat plane(float z)
{
	return cv::Mat(kImage, CV_32FC1, cv::Scalar(z));
}

InstanceMask disc(double x, double y, double radius)
{
	cv::Mat mask(kImage, CV_8UC1, cv::Scalar(0));
	for (int row = 0; row < kImage.height; ++row)
		for (int column = 0; column < kImage.width; ++column)
			if (std::hypot(column - x, row - y) < radius) mask.at<uint8_t>(row, column) = 255;
	return InstanceMask::encode(mask);
}

mrpt::poses::CPose3D translation(double x, double y, double z)
{
	return mrpt::poses::CPose3D(x, y, z, 0, 0, 0);
}
}  // namespace

TEST(MaskedSurface, HasItsCentreWhereTheMaskAndTheDepthSay)
{
	// 50 px right of the principal point at 2 m and f = 250: 0.4 m.
	const MaskedSurface surface(disc(210, 120, 30), plane(2), camera());
	ASSERT_TRUE(surface.extent());
	EXPECT_NEAR(surface.extent()->centre.x, 0.4, 0.01);
	EXPECT_NEAR(surface.extent()->centre.y, 0, 0.01);
	EXPECT_NEAR(surface.extent()->centre.z, 2, 1e-6);
	EXPECT_NEAR(surface.extent()->radius, 0.24 / std::sqrt(2.0), 0.01);
}

TEST(MaskedSurface, CentreIsNotMovedByAFewPixelsOfTheBackground)
{
	cv::Mat depth = plane(2);
	depth.colRange(225, 320).setTo(9);
	const MaskedSurface surface(disc(210, 120, 30), depth, camera());
	EXPECT_NEAR(surface.extent()->centre.z, 2, 1e-6);
	EXPECT_NEAR(surface.extent()->centre.x, 0.4, 0.1);
	// Half of a disc of 0.24 m lies within 0.24 / sqrt(2).
	EXPECT_NEAR(surface.extent()->radius, 0.24 / std::sqrt(2.0), 0.06);
}

TEST(MaskedSurface, SeenFromTheSamePlaceHasTheSameMask)
{
	for (const double radius : {3.0, 12.0, 60.0, 100.0})
	{
		const auto mask = disc(150, 110, radius);
		const auto projected = MaskedSurface(mask, plane(1.5), camera()).project(camera());
		EXPECT_GT(intersectionOverUnion(mask, projected), 0.93) << "radius " << radius;
	}
}

TEST(MaskedSurface, OfASmallMaskIsSampledPixelByPixelAndComesBackExactly)
{
	const auto mask = InstanceMask::encode(cv::Mat(20, 30, CV_8UC1, 255), {11, 13}, kImage);
	const MaskedSurface surface(mask, plane(1.7f), camera());
	EXPECT_EQ(surface.project(camera()), mask);
}

TEST(MaskedSurface, OfAThinMaskIsNotLost)
{
	for (const cv::Size size : {cv::Size(300, 1), cv::Size(1, 200), cv::Size(300, 4)})
	{
		const auto mask = InstanceMask::encode(cv::Mat(size, CV_8UC1, 255), {7, 9}, kImage);
		const MaskedSurface surface(mask, plane(2), camera(), 50);
		EXPECT_FALSE(surface.empty());
		EXPECT_GT(intersectionArea(surface.project(camera()), mask), mask.area() * 3 / 4);
	}
}

TEST(MaskedSurface, MovesWithTheCamera)
{
	// The camera goes 0.2 m to the right: 25 px at 2 m.
	MaskedSurface surface(disc(150, 110, 40), plane(2), camera());
	surface.transform(translation(-0.2, 0, 0));
	EXPECT_GT(intersectionOverUnion(surface.project(camera()), disc(125, 110, 40)), 0.93);
	EXPECT_NEAR(surface.extent()->centre.x, (125 - 160) / 250.0 * 2, 0.01);
}

TEST(MaskedSurface, GrowsWithoutHolesWhenTheCameraApproaches)
{
	// From 2 m to 1 m about the principal point: twice the size.
	MaskedSurface surface(disc(160, 120, 40), plane(2), camera());
	surface.transform(translation(0, 0, -1));
	EXPECT_GT(intersectionOverUnion(surface.project(camera()), disc(160, 120, 80)), 0.93);
}

TEST(MaskedSurface, TurnsWithTheCamera)
{
	// A roll of 90 degrees about the optical axis: (x, y) -> (-y, x).
	MaskedSurface surface(disc(200, 120, 30), plane(2), camera());
	surface.transform(mrpt::poses::CPose3D(0, 0, 0, M_PI / 2, 0, 0));
	EXPECT_GT(intersectionOverUnion(surface.project(camera()), disc(160, 160, 30)), 0.9);
}

TEST(MaskedSurface, KeepsItsShapeWhereDepthIsMissing)
{
	const auto mask = disc(150, 110, 40);
	cv::Mat depth = plane(2);
	depth.colRange(0, 150).setTo(0);
	depth.rowRange(0, 90).setTo(std::nanf(""));
	const auto projected = MaskedSurface(mask, depth, camera()).project(camera());
	EXPECT_GT(intersectionOverUnion(mask, projected), 0.93);
}

TEST(MaskedSurface, IsEmptyWithoutDepthOrMask)
{
	EXPECT_TRUE(MaskedSurface(disc(150, 110, 40), plane(0), camera()).empty());
	EXPECT_FALSE(MaskedSurface(disc(150, 110, 40), plane(0), camera()).extent());
	EXPECT_TRUE(MaskedSurface(disc(150, 110, 40), cv::Mat(), camera()).empty());
	EXPECT_TRUE(MaskedSurface(InstanceMask(kImage), plane(2), camera()).empty());
	EXPECT_EQ(MaskedSurface().project(camera()), InstanceMask(kImage));
}

TEST(MaskedSurface, BehindTheCameraOrBesideThePictureHasAnEmptyMask)
{
	MaskedSurface behind(disc(150, 110, 40), plane(2), camera());
	behind.transform(translation(0, 0, -3));
	EXPECT_TRUE(behind.project(camera()).empty());
	MaskedSurface beside(disc(150, 110, 40), plane(2), camera());
	beside.transform(translation(100, 0, 0));
	EXPECT_TRUE(beside.project(camera()).empty());
	EXPECT_EQ(beside.project(camera()).imageSize(), kImage);
	MaskedSurface lost(disc(150, 110, 40), plane(2), camera());
	lost.transform(translation(std::nan(""), 0, 0));
	EXPECT_TRUE(lost.project(camera()).empty());
}

TEST(MaskedSurface, IsCutOffAtTheEdgeOfThePicture)
{
	MaskedSurface surface(disc(160, 120, 40), plane(2), camera());
	surface.transform(translation(1.28, 0, 0));  // centre on the right edge, x = 320
	const auto projected = surface.project(camera());
	EXPECT_NEAR(double(projected.area()), M_PI * 40 * 40 / 2, 200);
	EXPECT_EQ(projected.boundingBox().br().x, 320);
}

TEST(MaskedSurface, RefusesADepthImageOfAnotherSizeOrType)
{
	const auto mask = disc(150, 110, 40);
	EXPECT_THROW(
		MaskedSurface(mask, cv::Mat(10, 10, CV_32FC1, cv::Scalar(2)), camera()), InputError);
	EXPECT_THROW(
		MaskedSurface(mask, cv::Mat(kImage, CV_16UC1, cv::Scalar(2)), camera()), InputError);
	auto broken = camera();
	broken.fx(0);
	EXPECT_THROW(MaskedSurface(mask, plane(2), broken), InputError);
}
