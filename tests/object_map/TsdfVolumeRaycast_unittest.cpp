#include <gtest/gtest.h>
#include <semloop/association/MaskedSurface.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/TsdfVolume.h>

#include "TsdfFixtures.h"

using namespace semloop;
using namespace semloop::testing;
using Eigen::Vector3d;

namespace
{
/** Root mean square and largest distance of the hits to the sphere [m]. */
std::pair<double, double> hitError(
	const ObjectPrediction& seen, const mrpt::poses::CPose3D& T_object_camera)
{
	double sum = 0, largest = 0;
	for (int r = 0; r < seen.depth.rows; ++r)
		for (int c = 0; c < seen.depth.cols; ++c)
		{
			const double z = seen.depth.at<float>(r, c);
			if (z == 0) continue;
			const double x = (seen.box.x + c * seen.stride - 319.5) / 525 * z;
			const double y = (seen.box.y + r * seen.stride - 239.5) / 525 * z;
			const double error = std::abs(T_object_camera.composePoint({x, y, z}).norm() - radius);
			sum += error * error;
			largest = std::max(largest, error);
		}
	return {std::sqrt(sum / cv::countNonZero(seen.depth)), largest};
}
}  // namespace

TEST(TsdfVolumeRaycast, ANewViewOfASphereHasItsSilhouetteAndDepth)
{
	const auto eye = lookAt(Vector3d(0.8, -0.6, 0.25).normalized());
	const View truth = render({sphere(radius)}, eye);  // 214 pixels across
	for (const int samples : {32, 64, 1000})
	{
		const auto seen = sphereFromAllAround().raycast(kinect(), -eye, samples);
		ASSERT_TRUE(seen.has_value());
		EXPECT_EQ(seen->mask.imageSize(), cv::Size(640, 480));
		EXPECT_GT(intersectionOverUnion(seen->mask, truth.mask), samples == 32 ? 0.94 : 0.96);
		EXPECT_LE(std::max(seen->depth.cols, seen->depth.rows), samples);
		const auto [rms, largest] = hitError(*seen, eye);
		EXPECT_LT(rms, 0.2 * voxel);
		EXPECT_LT(largest, 0.8 * voxel);
	}
}

TEST(TsdfVolumeRaycast, TheExtentIsThatOfADetectionOfTheSameThing)
{
	// Off the image's middle, so that box, stride and principal point all matter.
	const auto eye = lookAt({1.1, -0.4, 0.3}, {0.1, 0.15, -0.1});
	const View truth = render({sphere(radius)}, eye);
	const auto detected = MaskedSurface(truth.mask, truth.frame.depth, kinect()).extent();
	const auto seen = sphereFromAllAround().raycast(kinect(), -eye, 36);
	ASSERT_TRUE(seen && detected);
	const auto extent = seen->extent(kinect());
	ASSERT_TRUE(extent);
	EXPECT_LT((extent->centre - detected->centre).norm(), voxel);
	EXPECT_NEAR(extent->radius, detected->radius, voxel);
	EXPECT_FALSE(ObjectPrediction().extent(kinect()));
}

TEST(TsdfVolumeRaycast, CastPixelsCoverTheBox)
{
	for (const int samples : {4, 7, 64, 200})
	{
		const auto seen = sphereFromAllAround().raycast(kinect(), -lookAt({1, 0, 0}), samples);
		ASSERT_TRUE(seen.has_value());
		EXPECT_EQ(seen->depth.cols, (seen->box.width - 1) / seen->stride + 1);
		EXPECT_EQ(seen->depth.rows, (seen->box.height - 1) / seen->stride + 1);
		EXPECT_LE(std::max(seen->depth.cols, seen->depth.rows), samples);
		EXPECT_EQ(seen->box & seen->mask.boundingBox(), seen->mask.boundingBox());
	}
	EXPECT_THROW(sphereFromAllAround().raycast(kinect(), {}, 3), UsageError);
}

TEST(TsdfVolumeRaycast, ADistantObjectOfAFewPixelsIsSeen)
{
	const auto eye = lookAt({0, 12, 0});  // 17 pixels
	const auto seen = sphereFromAllAround().raycast(kinect(), -eye);
	ASSERT_TRUE(seen.has_value());
	EXPECT_EQ(seen->stride, 1);
	EXPECT_GT(intersectionOverUnion(seen->mask, render({sphere(radius)}, eye).mask), 0.85);
}

TEST(TsdfVolumeRaycast, AnObjectThatReachesOverTheImageBorderIsCut)
{
	for (const Vector3d& target :
		 {Vector3d(0, 0.6, 0), Vector3d(0, -0.6, 0), Vector3d(0, 0, 0.45), Vector3d(0, 0, -0.45),
		  Vector3d(0, 0.6, 0.45)})
	{
		const auto eye = lookAt({1, 0, 0}, target);
		const View truth = render({sphere(radius)}, eye);
		ASSERT_GT(truth.mask.area(), 1000U);
		const auto seen = sphereFromAllAround().raycast(kinect(), -eye);
		ASSERT_TRUE(seen.has_value());
		EXPECT_GT(intersectionOverUnion(seen->mask, truth.mask), 0.93);
	}
}

TEST(TsdfVolumeRaycast, AnObjectOutOfSightGivesNothing)
{
	const auto volume = sphereFromAllAround();
	EXPECT_FALSE(volume.raycast(kinect(), -lookAt({1, 0, 0}, {2, 0, 0})).has_value());  // behind
	EXPECT_FALSE(volume.raycast(kinect(), -lookAt({1, 0, 0}, {1, 2, 0})).has_value());  // beside
	EXPECT_FALSE(volume.raycast(kinect(), -lookAt({0.25, 0, 0}, {1, 0, 0})).has_value());
}

TEST(TsdfVolumeRaycast, FromInsideTheObjectNoFrontIsSeen)
{
	EXPECT_FALSE(
		sphereFromAllAround().raycast(kinect(), -lookAt({0.01, 0.02, 0}, {1, 0, 0})).has_value());
}

TEST(TsdfVolumeRaycast, CloseBeforeTheSurfaceTheWholeImageIsCovered)
{
	const auto seen = sphereFromAllAround().raycast(kinect(), -lookAt({0.3, 0, 0}));
	ASSERT_TRUE(seen.has_value());
	EXPECT_EQ(seen->mask.area(), 640U * 480U);
	const auto middle = seen->depth.at<float>(seen->depth.rows / 2, seen->depth.cols / 2);
	EXPECT_NEAR(middle, 0.1, 0.5 * voxel);
}

TEST(TsdfVolumeRaycast, InsideARoomItsWallsAreSeen)
{
	// The camera stands in a volume that surrounds it: a shell seen from within.
	const Shape room = [](const Vector3d& o, const Vector3d& d) -> std::optional<double>
	{
		const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
		return (-b + std::sqrt(b * b - a * c)) / a;
	};
	TsdfVolume volume(options(0.03));
	for (const double angle : {0.0, 0.9, 1.8, 2.7, 3.6, 4.5, 5.4})
		fuse(volume, {room}, lookAt({0, 0, 0}, {std::cos(angle), std::sin(angle), 0}));
	const auto eye = lookAt({0, 0, 0}, {1, 0.1, 0});
	const auto seen = volume.raycast(kinect(), -eye);
	ASSERT_TRUE(seen.has_value());
	// No view showed the last rows above and below.
	EXPECT_GT(seen->mask.area(), 0.96 * 640 * 480);
	const View truth = render({room}, eye);
	double largest = 0;
	for (int r = 0; r < seen->depth.rows; ++r)
		for (int c = 0; c < seen->depth.cols; ++c)
		{
			const float expected = truth.frame.depth.at<float>(
				seen->box.y + r * seen->stride, seen->box.x + c * seen->stride);
			const float found = seen->depth.at<float>(r, c);
			if (found > 0) largest = std::max<double>(largest, std::abs(found - expected));
		}
	EXPECT_LT(largest, 0.6 * 0.03);
}

TEST(TsdfVolumeRaycast, ASurfaceIsNotSeenFromItsBack)
{
	TsdfVolume volume(options(voxel));
	fuse(volume, {box({-0.3, 0, -0.3}, {0.3, 0.3, 0.3})}, lookAt({0, -1, 0}));
	EXPECT_TRUE(volume.raycast(kinect(), -lookAt({0, -1, 0})).has_value());
	EXPECT_FALSE(volume.raycast(kinect(), -lookAt({0, 1, 0})).has_value());
}

TEST(TsdfVolumeRaycast, AHoleStaysAHole)
{
	// Two bars with a gap of 20 pixels.
	const Shape upper = box({-0.2, 0, 0.02}, {0.2, 0.05, 0.12});
	const Shape lower = box({-0.2, 0, -0.12}, {0.2, 0.05, -0.02});
	const Shape both = [=](const Vector3d& o, const Vector3d& d)
	{
		const auto a = upper(o, d), b = lower(o, d);
		return a && (!b || *a < *b) ? a : b;
	};
	const auto eye = lookAt({0, -1, 0});
	TsdfVolume volume(options(0.005));
	fuse(volume, {both, box({-2, 1, -2}, {2, 1.1, 2})}, eye);
	const auto seen = volume.raycast(kinect(), -eye);
	ASSERT_TRUE(seen.has_value());
	EXPECT_FALSE(seen->mask.contains(320, 240));
	EXPECT_TRUE(seen->mask.contains(320, 200));
	EXPECT_TRUE(seen->mask.contains(320, 280));
}
