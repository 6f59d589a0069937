#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/FloorPlan.h>

#include <future>
#include <opencv2/core.hpp>

#include "BoxScene.h"
#include "HandMadeView.h"
#include "TemporaryFolder.h"

using namespace semloop;
using testing::HasSubstr;

namespace
{
constexpr float kWhite = 1.0F;

/** A plate of 0.4 x 0.4 m one metre above the floor: 60 x 60 px, two metres from the camera. */
Scene plateAboveFloor(double x = 0)
{
	Scene scene = emptyScene();
	addObject(scene, plate(0.4F, 0.4F, {kWhite, kWhite, kWhite}), x, 0, 1);
	return scene;
}

Scene lit(Scene scene, float x, float z, float intensity)
{
	scene.lights.push_back({{x, 0, z}, intensity});
	return scene;
}

void expectColor(const RenderedView& view, int x, int y, float irradiance)
{
	const auto color = view.color.at<cv::Vec3f>(y, x);
	EXPECT_NEAR(color[0], 0.2F * irradiance, 1e-3) << x << " " << y;
	EXPECT_NEAR(color[1], 0.4F * irradiance, 1e-3) << x << " " << y;
	EXPECT_NEAR(color[2], 0.6F * irradiance, 1e-3) << x << " " << y;
}
}  // namespace

TEST(SceneRenderer, DepthIsAlongTheOpticalAxis)
{
	const auto view = viewFromAbove(plateAboveFloor());
	EXPECT_NEAR(view.depth.at<float>(150, 150), 2, 1e-5);
	EXPECT_NEAR(view.depth.at<float>(150, 10), 3, 1e-5);
	EXPECT_NEAR(view.depth.at<float>(0, 300), 3, 1e-5);
}

TEST(SceneRenderer, EachPixelTellsItsObject)
{
	// Half of the plate is 0.2 m: 0.2 / 2 * 300 = 30 px.
	const auto view = viewFromAbove(plateAboveFloor());
	for (const int x : {121, 150, 179}) EXPECT_EQ(view.object.at<uint16_t>(150, x), 1) << x;
	for (const int x : {0, 119, 181, 300}) EXPECT_EQ(view.object.at<uint16_t>(150, x), 0) << x;
	EXPECT_NEAR(cv::countNonZero(view.object), 60 * 60, 2 * 61);
}

TEST(SceneRenderer, TheCosineIsThatOfRayAndNormal)
{
	const auto view = viewFromAbove(emptyScene());
	EXPECT_NEAR(view.cosine.at<float>(150, 150), 1, 1e-6);
	EXPECT_NEAR(view.cosine.at<float>(150, 300), 2 / std::sqrt(5.0), 1e-5);  // 150 of 300 px
}

TEST(SceneRenderer, RightAndUpInTheImageAreRightAndUpInTheWorld)
{
	Scene scene = emptyScene();
	addObject(scene, plate(0.2F, 0.2F, {1, 1, 1}), 1, 0, 0.01);
	addObject(scene, plate(0.2F, 0.2F, {1, 1, 1}), 0, 1, 0.01);
	const auto view = viewFromAbove(scene);
	EXPECT_EQ(view.object.at<uint16_t>(150, 250), 1);
	EXPECT_EQ(view.object.at<uint16_t>(50, 150), 2);
}

TEST(SceneRenderer, WhereNothingIsDepthIsZero)
{
	Scene scene = lit(emptyScene(), 0, 2, 3);
	scene.rooms = Mesh();
	addObject(scene, plate(0.4F, 0.4F, {1, 1, 1}), 0, 0, 1);
	const auto view = viewFromAbove(scene, true);
	EXPECT_NEAR(view.depth.at<float>(150, 150), 2, 1e-5);
	EXPECT_EQ(view.depth.at<float>(10, 10), 0);
	EXPECT_EQ(view.object.at<uint16_t>(10, 10), 0);
	EXPECT_EQ(view.cosine.at<float>(10, 10), 0);
	EXPECT_EQ(view.color.at<cv::Vec3f>(10, 10), cv::Vec3f(0, 0, 0));
}

TEST(SceneRenderer, LightFallsWithCosineAndSquaredDistance)
{
	// A lamp of 3 at 2 m: 3 / 4 below it; beside, at (1, 0), 3 * (2 / sqrt(5)) / 5.
	const auto view = viewFromAbove(lit(emptyScene(), 0, 2, 3), true);
	expectColor(view, 150, 150, 0.25F + 0.75F);
	expectColor(view, 250, 150, 0.25F + 3 * 2 / std::sqrt(5.0F) / 5);
}

TEST(SceneRenderer, LightsAddUpAndAmbientIsEverywhere)
{
	Scene scene = emptyScene();
	expectColor(viewFromAbove(scene, true), 150, 150, 0.25F);
	scene = lit(lit(scene, 0, 2, 3), 0, 1, 0.5F);
	expectColor(viewFromAbove(scene, true), 150, 150, 0.25F + 0.75F + 0.5F);
}

TEST(SceneRenderer, AmbientLightComesMoreFromAbove)
{
	// A wall gets three quarters, what looks down half of it.
	Scene scene = emptyScene();
	scene.rooms = plainMesh({1, 1, 1});
	addRectangle(scene.rooms, {-5, 2, -5}, {10, 0, 0}, {0, 0, 10});
	const auto forward = mrpt::poses::CPose3D(0, 0, 0, 0, 0, -M_PI / 2);
	const auto wall = SceneRenderer(scene).render(squareCamera(), forward, true);
	EXPECT_NEAR(wall.depth.at<float>(150, 150), 2, 1e-5);
	EXPECT_NEAR(wall.color.at<cv::Vec3f>(150, 150)[0], 0.75F * 0.25F, 1e-4);
	scene.rooms = plate(10, 10, {1, 1, 1});
	const auto upward = mrpt::poses::CPose3D(0, 0, -1, 0, 0, 0);
	const auto ceiling = SceneRenderer(scene).render(squareCamera(), upward, true);
	EXPECT_NEAR(ceiling.color.at<cv::Vec3f>(150, 150)[0], 0.5F * 0.25F, 1e-4);
}

TEST(SceneRenderer, BehindAnObjectIsItsShadow)
{
	// From the lamp at (1, 0, 2) past the plate at (0, 0, 1) light would reach (-1, 0, 0).
	const auto shaded = viewFromAbove(lit(plateAboveFloor(), 1, 2, 3), true);
	expectColor(shaded, 50, 150, 0.25F);
	const auto open = viewFromAbove(lit(emptyScene(), 1, 2, 3), true);
	expectColor(open, 50, 150, 0.25F + 3 * 2 / std::sqrt(8.0F) / 8);
	// Its own upper side is lit: distance^2 = 2, cosine 1 / sqrt(2).
	EXPECT_NEAR(shaded.color.at<cv::Vec3f>(150, 150)[0], 0.25F + 3 / std::sqrt(2.0F) / 2, 1e-3);
}

TEST(SceneRenderer, TexturesAreUprightAndRepeat)
{
	Scene scene = emptyScene();
	scene.ambient = 1;
	scene.rooms = plate(3, 3, {1, 1, 1});
	scene.rooms.materials[0].texture = 0;
	cv::Mat texture(2, 2, CV_8UC3);
	texture.at<cv::Vec3b>(0, 0) = {255, 0, 0};
	texture.at<cv::Vec3b>(0, 1) = {0, 255, 0};
	texture.at<cv::Vec3b>(1, 0) = {0, 0, 255};
	texture.at<cv::Vec3b>(1, 1) = {255, 255, 255};
	scene.rooms.textures.push_back(texture);
	const auto colorAt = [&](double x, double y) {
		return viewFromAbove(scene, true)
			.color.at<cv::Vec3f>(int(150 - 100 * y), int(150 + 100 * x));
	};
	EXPECT_EQ(colorAt(-0.7, 0.7), cv::Vec3f(1, 0, 0));
	EXPECT_EQ(colorAt(0.7, 0.7), cv::Vec3f(0, 1, 0));
	EXPECT_EQ(colorAt(-0.7, -0.7), cv::Vec3f(0, 0, 1));
	EXPECT_EQ(colorAt(0.7, -0.7), cv::Vec3f(1, 1, 1));
	// Twice as many in both directions.
	for (auto& triangle : scene.rooms.triangles)
		for (auto& uv : triangle.uv) uv *= 2;
	EXPECT_EQ(colorAt(-1.2, 1.2), cv::Vec3f(1, 0, 0));
	EXPECT_EQ(colorAt(0.3, 1.2), cv::Vec3f(1, 0, 0));
}

TEST(SceneRenderer, AHalfCoveredObjectIsHalfHidden)
{
	Scene scene = plateAboveFloor();
	// A plate above it, over x > 0 as the camera sees it.
	addObject(scene, plate(1, 1, {1, 1, 1}), 0.5, 0, 2);
	const SceneRenderer renderer(scene);
	const auto hidden =
		renderer.hiddenShares(renderer.render(squareCamera(), lookingDown(), false));
	ASSERT_EQ(hidden.size(), 3u);
	EXPECT_NEAR(hidden[1], 0.5, 0.05);
	EXPECT_EQ(hidden[2], 0);
}

TEST(SceneRenderer, WhatIsOutOfViewIsNotHiddenWhatIsBehindIsWholly)
{
	Scene scene = plateAboveFloor();
	addObject(scene, plate(0.2F, 0.2F, {1, 1, 1}), 0, 0, 0.5);
	addObject(scene, plate(0.2F, 0.2F, {1, 1, 1}), 4, 0, 0.5);
	addObject(scene, plate(0.2F, 0.2F, {1, 1, 1}), 0, 0, 4);
	const SceneRenderer renderer(scene);
	const auto hidden =
		renderer.hiddenShares(renderer.render(squareCamera(), lookingDown(), false));
	EXPECT_EQ(hidden[1], 0);
	EXPECT_EQ(hidden[2], 1) << "under the plate";
	EXPECT_EQ(hidden[3], 0) << "beside the image";
	EXPECT_EQ(hidden[4], 0) << "behind the camera";
}

TEST(SceneRenderer, ARoomHasNoGaps)
{
	Scene scene = emptyScene();
	scene.rooms =
		FloorPlan({{"a", {-2, -2}, {4, 4}}, {"b", {2.1, -2}, {4, 4}}}, {{{2.05, 0}, 0.9}}, 2.5)
			.mesh(1);
	const SceneRenderer renderer(scene);
	for (int i = 0; i < 8; ++i)
	{
		const mrpt::poses::CPose3D turned(0, 0, 1.2, i * M_PI / 4, 0, 0);
		const auto view = renderer.render(
			squareCamera(), turned + mrpt::poses::CPose3D(0, 0, 0, 0, 0, -M_PI / 2), false);
		EXPECT_EQ(cv::countNonZero(view.depth == 0), 0) << i;
	}
}

TEST(SceneRenderer, WithoutColourThereIsNone)
{
	EXPECT_TRUE(viewFromAbove(emptyScene()).color.empty());
}

TEST(SceneRenderer, DistortionIsRefused)
{
	auto camera = squareCamera();
	camera.cameraName = "fisheye";
	camera.setDistortionPlumbBob(0.1, 0, 0, 0, 0);
	const Scene scene = emptyScene();
	const SceneRenderer renderer(scene);
	EXPECT_THAT(
		messageOf<InputError>([&] { renderer.render(camera, lookingDown(), false); }),
		testing::AllOf(HasSubstr("'fisheye'"), HasSubstr("distortion")));
}

TEST(SceneRenderer, ThreadsSeeTheSame)
{
	const Scene scene = lit(plateAboveFloor(), 1, 2, 3);
	const SceneRenderer renderer(scene);
	const auto render = [&] { return renderer.render(squareCamera(), lookingDown(), true); };
	auto first = std::async(std::launch::async, render);
	auto second = std::async(std::launch::async, render);
	const auto a = first.get(), b = second.get();
	EXPECT_TRUE(sameBytes(a.depth, b.depth));
	EXPECT_TRUE(sameBytes(a.color, b.color));
	EXPECT_TRUE(sameBytes(a.object, b.object));
}
