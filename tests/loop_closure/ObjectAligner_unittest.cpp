#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/ObjectAligner.h>

#include <cmath>

#include "GraphFixtures.h"
#include "SyntheticScene.h"

namespace
{
using namespace semloop;
using namespace semloop::synthetic;
using testing::HasSubstr;

/** A box, an upright box and a ball on a table: together they leave no direction open. */
Scene threeObjects(const CPose3D& T = {})
{
	Scene scene;
	scene.boxes.push_back(
		{T + CPose3D(0.1, -0.4, 0.8, 0.3, 0, 0), {0.3, 0.2, 0.2}, {200, 0, 0}, 1, 0});
	scene.boxes.push_back(
		{T + CPose3D(-0.2, 0.4, 0.9, -0.5, 0, 0), {0.15, 0.25, 0.4}, {0, 200, 0}, 2, 0});
	scene.spheres.push_back({T.composePoint(TPoint3D(0.2, 0.05, 0.82)), 0.12, {0, 0, 200}, 3, 0});
	return scene;
}

/** Volumes in the world's frame, fused from cameras on an arc of the circle round the scene. */
std::vector<TsdfVolume> fused(const Scene& scene, double fromAngle, double toAngle)
{
	TsdfOptions options;
	options.voxelSize = 0.01;
	options.truncation = 0.04;
	std::vector<TsdfVolume> volumes(3, TsdfVolume(options));
	for (int i = 0; i < 4; ++i)
	{
		const double angle = fromAngle + (toAngle - fromAngle) * i / 3;
		const auto T_world_camera =
			lookAt({1.6 * std::cos(angle), 1.6 * std::sin(angle), 1.5}, {0, 0, 0.8});
		const auto view = renderView(scene, makeCamera(320, 240, 262), T_world_camera);
		for (int k = 0; k < 3; ++k)
			volumes[k].integrate(view.frame, view.masks[k + 1], T_world_camera);
	}
	return volumes;
}

std::vector<SurfacePair> pairsOf(
	const std::vector<TsdfVolume>& query, const std::vector<TsdfVolume>& target)
{
	const auto centre = [](const TsdfVolume& volume)
	{
		const auto box = volume.boundingBox();
		return (box->min + box->max) * 0.5;
	};
	std::vector<SurfacePair> pairs;
	for (std::size_t k = 0; k < query.size(); ++k)
		pairs.push_back(
			{query[k].surface(), target[k].surface(), centre(query[k]), centre(target[k])});
	return pairs;
}

/** The scene from the front; and moved by T, from the front and a side. */
class ObjectAlignerOnThreeObjects : public testing::Test
{
protected:
	static void SetUpTestSuite()
	{
		pairs = pairsOf(fused(threeObjects(), -0.7, 0.7), fused(threeObjects(T), -0.2, 1.5));
	}
	static void TearDownTestSuite() { pairs.clear(); }

	static void expectFound(const ObjectAlignment& result)
	{
		EXPECT_TRUE(result.accepted) << result.reason;
		// A voxel is 1 cm; the turn is about the scene's size of half a metre.
		const TPoint3D middle(0, 0, 0.8);
		EXPECT_LT(
			result.T_target_query.composePoint(middle).distanceTo(T.composePoint(middle)), 0.01);
		EXPECT_LT(fixtures::rotationAngle(result.T_target_query - T), 0.02);
		EXPECT_GT(result.fitness, 0.5);
		EXPECT_LT(result.rmse, 0.01);
	}

	static CPose3D semanticPose(double metres, double degrees)
	{
		const double angle = degrees * M_PI / 180;
		// Turned about the middle of the scene, then shifted.
		return T + CPose3D(metres, 0, 0.8, 0, 0, 0) + CPose3D(0, 0, 0, angle, 0, 0) +
			   CPose3D(0, 0, -0.8, 0, 0, 0);
	}

	static const CPose3D T;
	static std::vector<SurfacePair> pairs;
};

const CPose3D ObjectAlignerOnThreeObjects::T =
	CPose3D::FromXYZYawPitchRoll(0.3, -0.2, 0.05, 0.25, 0.02, -0.01);
std::vector<SurfacePair> ObjectAlignerOnThreeObjects::pairs;

TEST_F(ObjectAlignerOnThreeObjects, RecoversAKnownMotionFromTheSemanticPose)
{
	const ObjectAligner aligner;
	expectFound(aligner.align(pairs, semanticPose(0, 0)));
	expectFound(aligner.align(pairs, semanticPose(0.1, 5)));
	expectFound(aligner.align(pairs, semanticPose(-0.15, -10)));
}

TEST_F(ObjectAlignerOnThreeObjects, RecoversAKnownMotionWithFeatures)
{
	ObjectAligner aligner;
	aligner.options.method = "fpfh_ransac";
	expectFound(aligner.align(pairs, semanticPose(0.1, 5)));
}

TEST_F(ObjectAlignerOnThreeObjects, GivesTheSameBytesTwice)
{
	for (const std::string method : {"semantic_pose", "fpfh_ransac", "per_object_fpfh"})
	{
		ObjectAligner aligner;
		aligner.options.method = method;
		const auto a = aligner.align(pairs, semanticPose(0.1, 5));
		const auto b = aligner.align(pairs, semanticPose(0.1, 5));
		EXPECT_EQ(a.T_target_query.asString(), b.T_target_query.asString()) << method;
		EXPECT_EQ(a.fitness, b.fitness) << method;
		EXPECT_EQ(a.rmse, b.rmse) << method;
	}
}

TEST_F(ObjectAlignerOnThreeObjects, RefusesDisjointSurfaces)
{
	auto apart = pairs;
	for (auto& pair : apart)
	{
		for (auto& point : pair.query) point.position.x += 3;
		pair.queryCentre.x += 3;
		// The centres would agree, so that only the surfaces can say no.
		for (auto& point : pair.target) point.position.z += 1;
	}
	const auto shifted = T + CPose3D(-3, 0, 0, 0, 0, 0);
	const auto result = ObjectAligner().align(apart, shifted);
	EXPECT_FALSE(result.accepted);
	EXPECT_THAT(result.reason, HasSubstr("only 0 % of the surface points align"));
	EXPECT_EQ(result.fitness, 0);
	EXPECT_EQ(result.rmse, 0);
}

TEST_F(ObjectAlignerOnThreeObjects, RefusesAResultFarFromTheSemanticPose)
{
	ObjectAligner aligner;
	aligner.options.maxCorrection = 0.02;
	const auto result = aligner.align(pairs, semanticPose(0.1, 5));
	EXPECT_FALSE(result.accepted);
	EXPECT_THAT(result.reason, HasSubstr("away from the objects' centres, allowed are 0.02 m"));
}

TEST_F(ObjectAlignerOnThreeObjects, RefusesALargeResidual)
{
	ObjectAligner aligner;
	aligner.options.maxRmse = 0.0002;
	EXPECT_THAT(aligner.align(pairs, semanticPose(0, 0)).reason, HasSubstr("needed are 0.000 m"));
}

TEST_F(ObjectAlignerOnThreeObjects, FollowsTheFrameOfTheWorlds)
{
	// Far from the origin the same alignment, composed with where the worlds went.
	const CPose3D A = CPose3D::FromXYZYawPitchRoll(20, -30, 1, 1, 0, 0);
	auto far = pairs;
	for (auto& pair : far)
	{
		for (auto& point : pair.query)
		{
			point.position =
				mrpt::math::TPoint3Df(A.composePoint(mrpt::math::TPoint3D(point.position)));
			point.normal =
				mrpt::math::TVector3Df(A.rotateVector(mrpt::math::TVector3D(point.normal)));
		}
		pair.queryCentre = A.composePoint(pair.queryCentre);
	}
	const auto start = semanticPose(0.1, 5);
	auto result = ObjectAligner().align(far, start + (CPose3D() - A));
	result.T_target_query = result.T_target_query + A;
	expectFound(result);
}

TEST(ObjectAligner, ABallTellsThePosition)
{
	// Seen from 30 degrees apart. The turn is open, so only the centre is compared.
	std::vector<TsdfVolume> volumes(2);
	Scene scene;
	scene.spheres.push_back({{0, 0, 0.8}, 0.15, {0, 0, 200}, 1, 0});
	for (int i = 0; i < 2; ++i)
	{
		const double angle = i * M_PI / 6;
		const auto T_world_camera =
			lookAt({1.5 * std::cos(angle), 1.5 * std::sin(angle), 1.2}, {0, 0, 0.8});
		const auto view = renderView(scene, makeCamera(320, 240, 262), T_world_camera);
		volumes[i].integrate(view.frame, view.masks[1], T_world_camera);
	}
	const auto start = CPose3D(0.1, 0, 0, 0, 0, 0);
	const auto result = ObjectAligner().align(pairsOf({volumes[0]}, {volumes[1]}), start);
	EXPECT_TRUE(result.accepted) << result.reason;
	const TPoint3D centre(0, 0, 0.8);
	EXPECT_LT(result.T_target_query.composePoint(centre).distanceTo(centre), 0.01);
}

/** One shape from the front and from 30 degrees further round. */
MatchAlignment alignedAlone(const Scene& scene)
{
	std::vector<TsdfVolume> volumes(2);
	for (int i = 0; i < 2; ++i)
		for (const double side : {-0.3, 0.0, 0.3})
		{
			const double angle = i * M_PI / 6 + side;
			const auto T_world_camera =
				lookAt({1.5 * std::cos(angle), 1.5 * std::sin(angle), 1.2}, {0, 0, 0.8});
			const auto view = renderView(scene, makeCamera(320, 240, 262), T_world_camera);
			volumes[i].integrate(view.frame, view.masks[1], T_world_camera);
		}
	const auto result = ObjectAligner().align(pairsOf({volumes[0]}, {volumes[1]}), CPose3D());
	EXPECT_TRUE(result.accepted) << result.reason;
	EXPECT_EQ(result.pairs.size(), 1u);
	// A single pair is the joint problem: only its own say on rotation can differ.
	const auto alone = result.pairs.at(0);
	const double angle =
		std::remainder(alone.T_target_query.yaw() - result.T_target_query.yaw(), 2 * M_PI);
	EXPECT_LT(std::abs(angle), 0.02);
	return alone;
}

TEST(ObjectAligner, ARoundObjectHasNoSayOnTheYawASquareOneHas)
{
	const double floor = 1 / mrpt::square(ObjectAligner().options.rotationSigma);
	Scene round, square;
	round.spheres.push_back({{0, 0, 0.8}, 0.15, {0, 0, 200}, 1, 0});
	square.boxes.push_back({CPose3D(0, 0, 0.8, 0.4, 0, 0), {0.3, 0.3, 0.3}, {0, 0, 200}, 1, 0});
	const auto ball = alignedAlone(round), box = alignedAlone(square);
	EXPECT_NEAR(ball.information(5, 5), floor, 0.01);
	EXPECT_NEAR(ball.information(0, 5), 0, 0.1);
	EXPECT_GT(box.information(5, 5), 2 * floor);
	// Both say where they are.
	EXPECT_GT(ball.information(0, 0), 500);
	EXPECT_GT(box.information(0, 0), 500);
}

TEST_F(ObjectAlignerOnThreeObjects, FewObjectsFallBackOnFeatures)
{
	// A single box, from a semantic pose that is turned so far that the refinement takes its back for its front:
	// a single centre says nothing of the yaw.
	const std::vector<SurfacePair> one{pairs[1]};
	const auto start = semanticPose(0, 90);
	ObjectAligner aligner;
	aligner.options.maxCorrection = 2;
	aligner.options.fallbackBelow = 0;
	const auto without = aligner.align(one, start);
	EXPECT_GT(fixtures::rotationAngle(without.T_target_query - T), 1.5);
	aligner.options.fallbackBelow = 3;
	const auto with = aligner.align(one, start);
	ASSERT_TRUE(with.accepted) << with.reason;
	EXPECT_LT(fixtures::rotationAngle(with.T_target_query - T), 0.05);
	EXPECT_GT(with.fitness, without.fitness);
	// Three are enough to go by their centres.
	const auto three = aligner.align(pairs, start);
	aligner.options.fallbackBelow = 0;
	EXPECT_EQ(
		three.T_target_query.asString(), aligner.align(pairs, start).T_target_query.asString());
}

TEST_F(ObjectAlignerOnThreeObjects, AsPublishedEachObjectIsAlignedAlone)
{
	ObjectAligner aligner;
	aligner.options.method = "per_object_fpfh";
	const auto result = aligner.align(pairs, semanticPose(0.1, 5));
	ASSERT_TRUE(result.accepted) << result.reason;
	ASSERT_EQ(result.pairs.size(), 3u);
	const TPoint3D middle(0, 0, 0.8);
	EXPECT_LT(result.T_target_query.composePoint(middle).distanceTo(T.composePoint(middle)), 0.1);
	// The pose is that of one of them.
	EXPECT_TRUE(std::any_of(
		result.pairs.begin(), result.pairs.end(),
		[&](const MatchAlignment& alone)
		{ return alone.T_target_query.asString() == result.T_target_query.asString(); }));
}

TEST_F(ObjectAlignerOnThreeObjects, TheCovarianceIsThatOfTheErrorsAndGoesWithTheWorlds)
{
	const auto result = ObjectAligner().align(pairs, semanticPose(0.1, 5));
	// Errors of a few millimetres: neither certain nor vague.
	for (int i = 0; i < 3; ++i)
	{
		EXPECT_GT(std::sqrt(result.covariance(i, i)), 0.0003);
		EXPECT_LT(std::sqrt(result.covariance(i, i)), 0.02);
		EXPECT_LT(std::sqrt(result.covariance(3 + i, 3 + i)), 0.05);
	}
	// Another world for the target, turned by 90 degrees, says the same of the query's motion.
	const CPose3D A = CPose3D::FromXYZYawPitchRoll(5, 2, 0, M_PI / 2, 0, 0);
	auto elsewhere = pairs;
	for (auto& pair : elsewhere)
	{
		for (auto& point : pair.target)
		{
			point.position =
				mrpt::math::TPoint3Df(A.composePoint(mrpt::math::TPoint3D(point.position)));
			point.normal =
				mrpt::math::TVector3Df(A.rotateVector(mrpt::math::TVector3D(point.normal)));
		}
		pair.targetCentre = A.composePoint(pair.targetCentre);
	}
	const auto moved = ObjectAligner().align(elsewhere, A + semanticPose(0.1, 5));
	EXPECT_LT((moved.covariance - result.covariance).norm(), 0.2 * result.covariance.norm());
}

TEST_F(ObjectAlignerOnThreeObjects, AsPublishedTheCovarianceIsAboutTheSameMiddle)
{
	ObjectAligner aligner;
	const auto joint = aligner.align(pairs, semanticPose(0.05, 5));
	aligner.options.method = "per_object_fpfh";
	const auto single = aligner.align(pairs, semanticPose(0.05, 5));
	ASSERT_TRUE(joint.accepted && single.accepted);
	// One object tells less than three, most of all how the others' middle moves when it turns.
	for (int i = 0; i < 6; ++i) EXPECT_GT(single.covariance(i, i), joint.covariance(i, i)) << i;
	TPoint3D middle;
	for (const auto& pair : pairs) middle += pair.queryCentre * (1.0 / 3);
	double nearest = 1e9;  // whichever it is, it turns about a place near its own centre
	for (const auto& pair : pairs)
		nearest = std::min(
			nearest, std::hypot(pair.queryCentre.x - middle.x, pair.queryCentre.y - middle.y));
	EXPECT_GT(
		single.covariance(0, 0) + single.covariance(1, 1),
		0.5 * nearest * nearest * single.covariance(5, 5));
}

TEST_F(ObjectAlignerOnThreeObjects, OneWrongMatchDoesNotMoveTheOthers)
{
	// The chair that stands half a metre beside the right one.
	auto wrong = pairs;
	for (auto& point : wrong[2].target) point.position.x += 0.5f;
	wrong[2].targetCentre.x += 0.5;
	const auto result = ObjectAligner().align(wrong, semanticPose(0.1, 5));
	ASSERT_TRUE(result.accepted) << result.reason;
	const TPoint3D middle(0, 0, 0.8);
	EXPECT_LT(result.T_target_query.composePoint(middle).distanceTo(T.composePoint(middle)), 0.03);
	EXPECT_LT(fixtures::rotationAngle(result.T_target_query - T), 0.05);
}

TEST_F(ObjectAlignerOnThreeObjects, ABarelySeenObjectHasNoSayOnItsRotation)
{
	auto barely = pairs;
	auto& points = barely[0].query;
	ASSERT_GT(points.size(), 100u);
	// A patch of a few centimetres.
	const auto first = points.front().position;
	points.erase(
		std::remove_if(
			points.begin(), points.end(),
			[&](const SurfacePoint& p) { return (p.position - first).norm() > 0.06f; }),
		points.end());
	ObjectAligner aligner;
	const auto result = aligner.align(barely, semanticPose(0.05, 5));
	ASSERT_TRUE(result.accepted) << result.reason;
	const auto& alone = result.pairs[0];
	const double floor = 1 / mrpt::square(aligner.options.rotationSigma);
	for (int i = 3; i < 6; ++i) EXPECT_NEAR(alone.information(i, i), floor, 0.01) << i;
	EXPECT_LT(fixtures::rotationAngle(alone.T_target_query - result.T_target_query), 0.001);
	EXPECT_GT(result.pairs[1].information(5, 5), 2 * floor) << "the others were seen well";
}

TEST_F(ObjectAlignerOnThreeObjects, WhatWasNotSeenOfAnObjectWidensItsCentre)
{
	auto partly = pairs;
	partly[1].query.clear();  // its centre is all there is
	partly[1].centreVariance = 0.16;
	ObjectAligner aligner;
	const auto result = aligner.align(partly, semanticPose(0.05, 5));
	ASSERT_TRUE(result.accepted) << result.reason;
	EXPECT_NEAR(result.pairs[1].information(0, 0), 1 / (0.09 + 0.16), 1e-9);
	EXPECT_NEAR(result.pairs[1].information(2, 2), 1 / (0.09 + 0.16), 1e-9);
	// Of an object that does have a surface it is the least that is known.
	const auto known = aligner.align(pairs, semanticPose(0.05, 5)).pairs[0].information;
	auto vague = pairs;
	vague[0].centreVariance = 0.16;
	const auto wider = aligner.align(vague, semanticPose(0.05, 5)).pairs[0].information;
	EXPECT_LT(wider.topLeftCorner(3, 3).trace(), known.topLeftCorner(3, 3).trace());
}

TEST(ObjectAligner, WithoutSurfacesThereIsNothingToAlign)
{
	const auto T = CPose3D(1, 2, 3, 0, 0, 0);
	for (const std::string method : {"semantic_pose", "fpfh_ransac", "per_object_fpfh"})
	{
		ObjectAligner aligner;
		aligner.options.method = method;
		const auto none = aligner.align(std::vector<SurfacePair>{}, T);
		EXPECT_FALSE(none.accepted);
		EXPECT_THAT(none.reason, HasSubstr("none of the 0 matched pairs has a surface"));
		const auto bare = aligner.align(std::vector<SurfacePair>(3), T);
		EXPECT_FALSE(bare.accepted);
		EXPECT_EQ(bare.T_target_query, T) << "no better pose is known";
	}
}

TEST(ObjectAligner, ASinglePointOnEachSideDoesNoHarm)
{
	SurfacePair pair;
	pair.query = {{{1, 0, 0}, {0, 0, 1}, {}}};
	pair.target = {{{1, 0, 0}, {0, 0, 1}, {}}};
	pair.queryCentre = pair.targetCentre = {1, 0, 0};
	for (const std::string method : {"semantic_pose", "fpfh_ransac", "per_object_fpfh"})
	{
		ObjectAligner aligner;
		aligner.options.method = method;
		const auto result = aligner.align(std::vector<SurfacePair>{pair}, CPose3D());
		EXPECT_EQ(result.accepted, method == "semantic_pose") << result.reason;
		EXPECT_TRUE(std::isfinite(result.T_target_query.x()));
	}
}

TEST(ObjectAligner, AnUnknownMethodIsAUsageError)
{
	mrpt::config::CConfigFileMemory config;
	config.write("alignment", "method", "guess");
	ObjectAligner aligner;
	EXPECT_THROW(aligner.configure(config, "alignment"), UsageError);
	config.write("alignment", "method", "fpfh_ransac");
	aligner.configure(config, "alignment");
	EXPECT_EQ(aligner.options.method, "fpfh_ransac");
}
}  // namespace
