#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

TEST(CObjectMapPrediction, ThePredictedMasksAreTheOnesSeenFromANewPlace)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const CPose3D T_world_camera = lookAt({1.0, -0.9, 1.2}, {0, 0.2, 0.8});
	const View view = renderView(ballAndBox(), testCamera(), T_world_camera);
	const auto predicted = map.predict(view.frame.camera, T_world_camera, view.frame.depth);
	ASSERT_EQ(predicted.size(), 2U);
	EXPECT_EQ(predicted[0].id, 0U);  // the ball is nearer
	EXPECT_EQ(predicted[1].id, 1U);
	EXPECT_GT(intersectionOverUnion(predicted[0].prediction.mask, view.masks[1]), 0.85);
	EXPECT_GT(intersectionOverUnion(predicted[1].prediction.mask, view.masks[2]), 0.8);
}

TEST(CObjectMapPrediction, ThePredictedDepthIsTheSurfaces)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const View view = renderView(ballAndBox(), testCamera(), onCircle(3, 8));
	for (const auto& predicted : map.predict(view.frame.camera, onCircle(3, 8), view.frame.depth))
	{
		const auto& prediction = predicted.prediction;
		int good = 0, all = 0;
		for (int v = 0; v < prediction.depth.rows; ++v)
			for (int u = 0; u < prediction.depth.cols; ++u)
			{
				const float z = prediction.depth.at<float>(v, u);
				if (z == 0) continue;
				const float truth = view.frame.depth.at<float>(
					prediction.box.y + v * prediction.stride,
					prediction.box.x + u * prediction.stride);
				good += std::abs(z - truth) < 0.01f;
				++all;
			}
		ASSERT_GT(all, 100);
		EXPECT_GT(good, 0.9 * all);
	}
}

TEST(CObjectMapPrediction, AnObjectHidesWhatIsBehindItEvenWithoutADepthImage)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const CPose3D T_world_camera = lookAt({0.4, -1.2, 0.95}, {0, 0.45, 0.8});
	const View view = renderView(ballAndBox(), testCamera(), T_world_camera);
	const auto predicted = map.predict(view.frame.camera, T_world_camera);
	ASSERT_EQ(predicted.size(), 2U);
	EXPECT_EQ(predicted[0].id, 0U);
	EXPECT_GT(predicted[0].visibleShare, 0.99);
	EXPECT_LT(predicted[1].visibleShare, 0.9);
	EXPECT_GT(intersectionOverUnion(predicted[1].prediction.mask, view.masks[2]), 0.7);
	EXPECT_LT(
		double(intersectionArea(predicted[0].prediction.mask, predicted[1].prediction.mask)),
		0.05 * double(predicted[1].prediction.mask.area()));
}

TEST(CObjectMapPrediction, WhatTheDepthMeasuresInFrontHidesAnObject)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	Scene scene = ballAndBox();
	// A board that nobody mapped covers the half of the ball on the camera's right side (y > 0).
	scene.boxes.push_back({CPose3D(0.5, 0.25, 0.9, 0, 0, 0), {0.02, 0.5, 0.6}, {9, 9, 9}, 0, 0});
	const CPose3D T_world_camera = lookAt({1.3, 0, 0.85}, {0, 0, 0.85});
	const View view = renderView(scene, testCamera(), T_world_camera);
	const auto predicted = map.predict(view.frame.camera, T_world_camera, view.frame.depth);
	ASSERT_EQ(predicted.size(), 1U);  // the box is wholly behind the board
	EXPECT_EQ(predicted[0].id, 0U);
	EXPECT_NEAR(predicted[0].visibleShare, 0.5, 0.05);
	EXPECT_GT(intersectionOverUnion(predicted[0].prediction.mask, view.masks[1]), 0.85);
	EXPECT_EQ(map.predict(view.frame.camera, T_world_camera).size(), 2U);
}

TEST(CObjectMapPrediction, ObjectsThatAreLeftOutNeitherAppearNorHide)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const CPose3D T_world_camera = lookAt({1.3, 0, 0.85}, {0, 0, 0.85});
	const auto both = map.predict(testCamera(), T_world_camera);
	ASSERT_EQ(both.size(), 2U);
	const auto far = both[1].id;
	const auto alone = map.predict(testCamera(), T_world_camera, {}, std::set<ObjectId>{far});
	ASSERT_EQ(alone.size(), 1U);
	EXPECT_EQ(alone[0].id, far);
	EXPECT_DOUBLE_EQ(alone[0].visibleShare, 1.0);
	EXPECT_TRUE(map.predict(testCamera(), T_world_camera, {}, std::set<ObjectId>{}).empty());
}

TEST(CObjectMapPrediction, ObjectsOutsideOfTheViewAreNotPredicted)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const TPoint3D eye(1.3, 0, 1.2);
	EXPECT_TRUE(map.predict(testCamera(), lookAt(eye, {2.3, 0, 1.2})).empty());
	EXPECT_TRUE(map.predict(testCamera(), lookAt(eye, {1.3, 2, 1.2})).empty());
	EXPECT_TRUE(map.predict(testCamera(), lookAt(eye, {1.3, 0, 5})).empty());
	EXPECT_EQ(map.predict(testCamera(), lookAt(eye, {0, 0.2, 0.8})).size(), 2U);
}

TEST(CObjectMapPrediction, ADuplicateDoesNotHideItsTwin)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	const auto twin = map.addObject(view.frame, makeInstance(view.masks[1], kCup), onCircle(0, 8));
	for (const auto& predicted : map.predict(view.frame.camera, onCircle(0, 8), view.frame.depth))
		if (predicted.id == 0 || predicted.id == *twin)
		{
			EXPECT_GT(predicted.visibleShare, 0.95);
		}
}

TEST(CObjectMapPrediction, AMovedObjectIsPredictedAtItsNewPlace)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const CPose3D shift(-0.2, -0.3, 0, 0, 0, 0);
	map.moveObjects({{0, shift + map.object(0).T_world_object}});
	Scene scene = ballAndBox();
	scene.spheres[0].centre += TPoint3D(-0.2, -0.3, 0);
	const View view = renderView(scene, testCamera(), onCircle(0, 8));
	const auto predicted = map.predict(view.frame.camera, onCircle(0, 8), view.frame.depth);
	ASSERT_EQ(predicted.size(), 2U);
	const auto& ball = predicted[predicted[0].id == 0 ? 0 : 1];
	EXPECT_GT(intersectionOverUnion(ball.prediction.mask, view.masks[1]), 0.85);
	EXPECT_THROW(map.moveObjects({{0, CPose3D()}, {9, CPose3D()}}), std::out_of_range);
	EXPECT_EQ(map.predict(view.frame.camera, onCircle(0, 8)).size(), 2U);
}

TEST(CObjectMapPrediction, RefusesADepthImageOfAnotherCamera)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const cv::Mat depth = cv::Mat::zeros(48, 64, CV_32FC1);
	EXPECT_THROW(map.predict(testCamera(), CPose3D(), depth), InputError);
	EXPECT_THROW(
		map.predict(testCamera(), CPose3D(), cv::Mat::zeros(240, 320, CV_16UC1)), InputError);
}
