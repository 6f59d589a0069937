#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include <limits>

#include "TsdfFixtures.h"

using namespace semloop;
using namespace semloop::testing;
using Eigen::Vector3d;

TEST(TsdfVolume, AnEmptyVolumeHasNothing)
{
	const TsdfVolume volume;
	EXPECT_TRUE(volume.empty());
	EXPECT_TRUE(volume.surface().empty());
	EXPECT_TRUE(volume.mesh().vertices.empty());
	EXPECT_TRUE(volume.mesh().triangles.empty());
	EXPECT_FALSE(volume.boundingBox().has_value());
	EXPECT_FALSE(volume.distance({0, 0, 0}).has_value());
	EXPECT_FALSE(volume.raycast(kinect(), {}).has_value());
	EXPECT_TRUE(volumeOf(bytesOf(volume)).empty());
}

TEST(TsdfVolume, RefusesImpossibleOptions)
{
	for (const auto& wrong :
		 {TsdfOptions{0, 0.04, 64, 10}, TsdfOptions{0.01, 0.005, 64, 10},
		  TsdfOptions{0.01, 0.04, 0, 10}, TsdfOptions{0.01, 0.04, 64, 0},
		  TsdfOptions{std::nan(""), 0.04, 64, 10}})
		EXPECT_THROW(TsdfVolume{wrong}, UsageError);
}

TEST(TsdfVolume, RefusesImagesThatDoNotFit)
{
	TsdfVolume volume;
	const View good = render({sphere(radius)}, lookAt({1, 0, 0}));
	View view = good;
	view.mask = InstanceMask(cv::Size(320, 240));
	EXPECT_THROW(volume.integrate(view.frame, view.mask, {}), InputError);
	view = good;
	view.frame.depth.convertTo(view.frame.depth, CV_16UC1, 1000);
	EXPECT_THROW(volume.integrate(view.frame, view.mask, {}), InputError);
	view = good;
	view.frame.color = view.frame.color.rowRange(0, 100);
	EXPECT_THROW(volume.integrate(view.frame, view.mask, {}), InputError);
	view = good;
	view.frame.camera.setIntrinsicParamsFromValues(0, 0, 319.5, 239.5);
	EXPECT_THROW(volume.integrate(view.frame, view.mask, {}), InputError);
	EXPECT_TRUE(volume.empty());
}

TEST(TsdfVolume, RefusesPosesThatAreNotFinite)
{
	auto volume = sphereFromAllAround();
	const View view = render({sphere(radius)}, lookAt({1, 0, 0}));
	const mrpt::poses::CPose3D nowhere(std::nan(""), 0, 0, 0, 0, 0);
	EXPECT_THROW(volume.integrate(view.frame, view.mask, nowhere), InputError);
	EXPECT_THROW(volume.merge(sphereFromAllAround(), nowhere), InputError);
	EXPECT_THROW(volume.raycast(kinect(), nowhere), InputError);
	EXPECT_EQ(bytesOf(volume), bytesOf(sphereFromAllAround()));
}

TEST(TsdfVolume, ASphereSeenFromAllAroundLiesWithinAFractionOfAVoxel)
{
	const auto points = sphereFromAllAround().surface();
	// Area in voxel faces is 4 pi 20^2 = 5027; edges cross a sphere 1.5 times as often.
	EXPECT_NEAR(static_cast<double>(points.size()), 7540, 300);
	const auto [rms, largest] = sphereError(points);
	EXPECT_LT(rms, 0.15 * voxel);
	EXPECT_LT(largest, 0.6 * voxel);
}

TEST(TsdfVolume, NormalsHaveUnitLengthAndPointOutwards)
{
	double sum = 0;
	const auto points = sphereFromAllAround().surface();
	for (const auto& point : points)
	{
		EXPECT_NEAR(point.normal.norm(), 1, 1e-5);
		const double cosine = eigen(point.position)
								  .normalized()
								  .dot(Vector3d(point.normal.x, point.normal.y, point.normal.z));
		EXPECT_GT(cosine, 0.7);
		sum += cosine;
	}
	EXPECT_GT(sum / static_cast<double>(points.size()), 0.99);
}

TEST(TsdfVolume, ABoxKeepsItsFacesAndItsExtent)
{
	const Vector3d low(-0.15, -0.2, -0.1), high(0.15, 0.2, 0.1);
	TsdfVolume volume(options(voxel));
	for (const auto& pose : posesAllAround(1.2)) fuse(volume, {box(low, high)}, pose);
	for (const auto& point : volume.surface())
	{
		const Vector3d p = eigen(point.position);
		const Vector3d outside = (low - p).cwiseMax(p - high);  // all negative inside
		EXPECT_LT(std::abs(outside.maxCoeff()), voxel);
	}
	const auto found = volume.boundingBox();
	ASSERT_TRUE(found.has_value());
	for (int i = 0; i < 3; ++i)
	{
		EXPECT_NEAR(found->min[i], low[i], 0.5 * voxel);
		EXPECT_NEAR(found->max[i], high[i], 0.5 * voxel);
	}
}

TEST(TsdfVolume, DistanceIsPositiveInFrontNegativeBehindAndEmptyElsewhere)
{
	TsdfVolume volume(options(voxel));
	fuse(volume, {sphere(radius)}, lookAt({0, -1, 0}));
	for (const double s : {-0.03, -0.01, 0.0, 0.01, 0.03})
	{
		const auto d = volume.distance({0, -radius - s, 0});
		ASSERT_TRUE(d.has_value());
		EXPECT_NEAR(*d, s, 0.002);
	}
	EXPECT_FALSE(volume.distance({0, radius, 0}).has_value());  // hidden by the front
	EXPECT_FALSE(volume.distance({0, 100, 0}).has_value());
	EXPECT_FALSE(volume.distance({0, 1e30, 0}).has_value());
	EXPECT_FALSE(volume.distance({0, std::nan(""), 0}).has_value());
}

TEST(TsdfVolume, FramesWithoutDepthChangeNothing)
{
	TsdfVolume volume = sphereFromAllAround();
	const auto before = bytesOf(volume);
	View view = render({sphere(radius)}, lookAt({1, 0, 0}));
	for (const float nothing :
		 {0.F, -1.F, std::numeric_limits<float>::quiet_NaN(),
		  std::numeric_limits<float>::infinity()})
	{
		view.frame.depth.setTo(nothing);
		volume.integrate(view.frame, view.mask, lookAt({1, 0, 0}));
		EXPECT_EQ(bytesOf(volume), before) << nothing;
		TsdfVolume fresh(options(voxel));
		fresh.integrate(view.frame, view.mask, lookAt({1, 0, 0}));
		EXPECT_TRUE(fresh.empty());
	}
}

TEST(TsdfVolume, InvalidPixelsAmongGoodOnesDoNoHarm)
{
	TsdfVolume volume(options(voxel));
	for (const auto& pose : posesAllAround(1.0))
	{
		View view = render({sphere(radius)}, pose);
		for (int v = 0; v < 480; ++v)
			for (int u = (v * 7) % 5; u < 640; u += 5)
				view.frame.depth.at<float>(v, u) = u % 3 == 0   ? 0.F
												   : u % 3 == 1 ? std::nanf("")
																: HUGE_VALF;
		volume.integrate(view.frame, view.mask, pose);
	}
	EXPECT_LT(sphereError(volume.surface()).second, 0.6 * voxel);
}

TEST(TsdfVolume, AMaskOfOnePixelAllocates)
{
	TsdfVolume volume(options(voxel));
	View view = render({sphere(radius)}, lookAt({1, 0, 0}));
	view.mask = InstanceMask({640, 480}, {{240, 320, 321}});
	volume.integrate(view.frame, view.mask, lookAt({1, 0, 0}));
	EXPECT_GT(volume.blockCount(), 0U);
}

TEST(TsdfVolume, CarvingRemovesASurfaceThatWentAway)
{
	const auto eye = lookAt({0, -1, 0});
	const Shape wall = box({-2, 0.8, -2}, {2, 1, 2});
	TsdfVolume volume(options(voxel));
	for (int i = 0; i < 3; ++i) fuse(volume, {sphere(radius)}, eye);
	ASSERT_GT(volume.surface().size(), 1000U);
	ASSERT_TRUE(volume.raycast(kinect(), -eye).has_value());

	View gone = render({wall}, eye);
	gone.mask = InstanceMask(cv::Size(640, 480));
	// d = (3 d0 + n T) / (3 + n) > 0 for every d0 > -T once n >= 3; the weights are below 1 m / z.
	for (int i = 0; i < 12; ++i) volume.integrate(gone.frame, gone.mask, eye);
	EXPECT_TRUE(volume.surface().empty());
	EXPECT_TRUE(volume.mesh().triangles.empty());
	EXPECT_FALSE(volume.boundingBox().has_value());
	EXPECT_FALSE(volume.raycast(kinect(), -eye).has_value());
}

TEST(TsdfVolume, WhatHidesTheObjectDoesNotCarveIt)
{
	const auto eye = lookAt({0, -1, 0});
	TsdfVolume volume(options(voxel));
	fuse(volume, {sphere(radius)}, eye);
	const auto before = volume.surface().size();
	View hidden = render({box({-1, -0.7, -1}, {1, -0.6, 1})}, eye);
	hidden.mask = InstanceMask(cv::Size(640, 480));
	for (int i = 0; i < 20; ++i) volume.integrate(hidden.frame, hidden.mask, eye);
	EXPECT_EQ(volume.surface().size(), before);
}

TEST(TsdfVolume, MaskThatLeakedOnceOntoTheTableIsOutvoted)
{
	const Shape ball = sphere(radius);
	const Shape table = box({-1, -1, -0.3}, {1, 1, -radius});
	const auto eye = lookAt({0, -1, 0.6});
	TsdfVolume volume(options(voxel));
	View leaked = render({ball, table}, eye);
	cv::Mat wide = leaked.mask.decode();
	wide(cv::Rect(220, 300, 200, 100)).setTo(255);  // the table before the ball
	leaked.mask = InstanceMask::encode(wide);
	volume.integrate(leaked.frame, leaked.mask, eye);
	const auto tablePoints = [&]
	{
		int count = 0;
		for (const auto& p : volume.surface()) count += eigen(p.position).norm() > radius + 0.03;
		return count;
	};
	EXPECT_GT(tablePoints(), 200);

	for (int i = 0; i < 2; ++i) fuse(volume, {ball, table}, eye);
	EXPECT_LT(tablePoints(), 20);
	EXPECT_GT(volume.surface().size(), 1500U);
}

TEST(TsdfVolume, MixedPixelsBehindTheRimAreNotFused)
{
	const auto eye = lookAt({0, -1, 0});
	View view = render({sphere(radius), box({-2, 0.8, -2}, {2, 1, 2})}, eye);
	// A ring of pixels between object and wall, in a mask that is a pixel too large.
	const cv::Mat mask = view.mask.decode();
	cv::Mat grown = mask.clone();
	for (int v = 1; v < 479; ++v)
		for (int u = 1; u < 639; ++u)
			if (!mask.at<uint8_t>(v, u) &&
				(mask.at<uint8_t>(v, u - 1) || mask.at<uint8_t>(v, u + 1) ||
				 mask.at<uint8_t>(v - 1, u) || mask.at<uint8_t>(v + 1, u)))
			{
				grown.at<uint8_t>(v, u) = 255;
				view.frame.depth.at<float>(v, u) = 1.3F;
			}
	TsdfVolume volume(options(voxel));
	volume.integrate(view.frame, InstanceMask::encode(grown), eye);
	for (const auto& p : volume.surface()) EXPECT_LT(p.position.y, 0.1F);
}

TEST(TsdfVolume, GrowsBeyondWhatWasFirstSeen)
{
	const Shape bar = box({-0.5, -0.05, -0.05}, {0.5, 0.05, 0.05});
	TsdfVolume volume(options(voxel));
	View view = render({bar}, lookAt({0, -1, 0.3}));
	cv::Mat left = view.mask.decode();
	left.colRange(320, 640).setTo(0);
	volume.integrate(view.frame, InstanceMask::encode(left), lookAt({0, -1, 0.3}));
	const auto half = volume.boundingBox();
	ASSERT_TRUE(half.has_value());
	EXPECT_NEAR(half->max.x - half->min.x, 0.5, 2 * voxel);
	for (int i = 0; i < 3; ++i) fuse(volume, {bar}, lookAt({0, -1, 0.3}));
	const auto whole = volume.boundingBox();
	ASSERT_TRUE(whole.has_value());
	EXPECT_NEAR(whole->max.x - whole->min.x, 1.0, 2 * voxel);
}

TEST(TsdfVolume, NeverTakesMoreBlocksThanAllowed)
{
	auto few = options(voxel);
	few.maxBlocks = 50;
	TsdfVolume volume(few);
	for (const auto& pose : posesAllAround(1.0)) fuse(volume, {sphere(radius)}, pose);
	EXPECT_LE(volume.blockCount(), 50U);
	EXPECT_LT(volume.memoryBytes(), 50U * 6600U);
	EXPECT_FALSE(volume.surface().empty());
}

TEST(TsdfVolume, ColourIsThatOfTheObject)
{
	const auto volume = sphereFromAllAround();
	for (const auto& point : volume.surface())
	{
		EXPECT_EQ(point.color.R, 100);
		EXPECT_EQ(point.color.G, 100);
		EXPECT_EQ(point.color.B, 100);
	}
}
