#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/loop_closure/GeometricVerification.h>
#include <semloop/loop_closure/SpectralMatcher.h>

#include <cmath>
#include <random>

#include "GraphFixtures.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using Outcome = GeometricVerification::Outcome;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;
using testing::HasSubstr;

void expectNear(const CPose3D& a, const CPose3D& b, double metres, double radians)
{
	EXPECT_LT(a.distanceTo(b), metres) << a << " and " << b;
	EXPECT_LT(fixtures::rotationAngle(a - b), radians) << a << " and " << b;
}

TEST(FitYawAndTranslation, IsExactForAMotionThatKeepsGravity)
{
	const auto T = yawPose(1, -2, 0.5, 2.5);
	std::vector<std::pair<TPoint3D, TPoint3D>> pairs;
	for (const auto& v : fourObjects().vertices)
		pairs.emplace_back(v.position, T.composePoint(v.position));
	expectNear(*fitYawAndTranslation(pairs), T, 1e-9, 1e-9);
}

TEST(FitYawAndTranslation, AQuarterTurnByHand)
{
	// x -> y, y -> -x, up by 1.
	const auto T = fitYawAndTranslation({{{1, 0, 0}, {0, 1, 1}}, {{-1, 0, 0}, {0, -1, 1}}});
	expectNear(*T, yawPose(0, 0, 1, M_PI / 2), 1e-9, 1e-9);
}

TEST(FitYawAndTranslation, IsALeastSquaresFit)
{
	// No small change of any of the four parameters makes the sum of squares smaller.
	std::mt19937 random(1);
	std::normal_distribution<double> noise(0, 0.1);
	std::vector<std::pair<TPoint3D, TPoint3D>> pairs;
	for (const auto& v : randomRoom(10, 1, 2).vertices)
		pairs.emplace_back(
			v.position, yawPose(1, 2, 3, 0.7).composePoint(v.position) +
							TPoint3D(noise(random), noise(random), noise(random)));
	const auto cost = [&](const CPose3D& T)
	{
		double sum = 0;
		for (const auto& [q, t] : pairs) sum += (T.composePoint(q) - t).sqrNorm();
		return sum;
	};
	const auto T = *fitYawAndTranslation(pairs);
	for (const double step : {-1e-3, 1e-3})
	{
		EXPECT_GT(cost(yawPose(T.x() + step, T.y(), T.z(), T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y() + step, T.z(), T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y(), T.z() + step, T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y(), T.z(), T.yaw() + step)), cost(T));
	}
}

TEST(FitYawAndTranslation, IsEmptyWhenTheYawIsOpen)
{
	EXPECT_FALSE(fitYawAndTranslation({}));
	EXPECT_FALSE(fitYawAndTranslation({{{1, 2, 3}, {4, 5, 6}}}));
	EXPECT_FALSE(fitYawAndTranslation({{{1, 2, 3}, {4, 5, 6}}, {{1, 2, 9}, {4, 5, 12}}}));
}

TEST(GeometricVerification, ConfirmsARigidMotionAndFindsIt)
{
	const auto query = fourObjects();
	const auto T = yawPose(3, -1, 0.2, -2);
	const auto result = verifyGeometry(query, moved(query, T), identityMatches(4));
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
	EXPECT_EQ(result.inliers, identityMatches(4));
	EXPECT_NEAR(result.rmse, 0, 1e-9);
	expectNear(result.T_target_query, T, 1e-9, 1e-9);
	EXPECT_LT(result.runnerUp, 0.5);
}

TEST(GeometricVerification, DropsAWrongMatch)
{
	auto query = randomRoom(8, 8, 1);
	const auto T = yawPose(0.5, 0.4, 0, 0.3);
	auto target = moved(query, T);
	target.vertices[5].position += TPoint3D(1, 0, 0);
	const auto result = verifyGeometry(query, target, identityMatches(8));
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
	EXPECT_EQ(result.inliers.size(), 7);
	for (const auto& match : result.inliers) EXPECT_NE(match.query, 5);
	expectNear(result.T_target_query, T, 1e-9, 1e-9);
}

TEST(GeometricVerification, MatchesAgainUnderThePose)
{
	// Vertices 0 and 1 have one label and were swapped by the matcher; 7 was not matched at all.
	auto query = randomRoom(8, 8, 3);
	query.vertices[0].label = query.vertices[1].label = "chair";
	const auto target = moved(query, yawPose(1, 1, 0, 1));
	auto matches = identityMatches(7);
	std::swap(matches[0].target, matches[1].target);
	EXPECT_EQ(verifyGeometry(query, target, matches).inliers, identityMatches(8));
}

TEST(GeometricVerification, RejectsAMirroredScene)
{
	// All distances and heights are those of the original: only a rigid motion can tell.
	for (unsigned seed = 0; seed < 20; ++seed)
	{
		const auto query = randomRoom(10, 10, seed);
		auto target = query;
		for (auto& v : target.vertices) v.position.x = -v.position.x;
		ASSERT_EQ(matchedEdgeShare(query, target, identityMatches(10), 1e-6), 1);
		const auto result = verifyGeometry(query, target, identityMatches(10));
		EXPECT_EQ(result.outcome, Outcome::Refuted) << "seed " << seed << ": " << result.reason;
	}
}

TEST(GeometricVerification, AFlatSceneIsItsOwnMirrorImageAndStillConfirmed)
{
	// Monitors, a lamp and a printer along a wall.
	const auto wall = complete(
		{vertex(0, "lamp", 0, 0, 1.2), vertex(1, "monitor", 0.7, 0, 0.9),
		 vertex(2, "monitor", 1.4, 0, 0.9), vertex(3, "printer", 2.5, 0, 0.8)});
	const auto result = verifyGeometry(wall, moved(wall, yawPose(1, 2, 0, 1)), identityMatches(4));
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
}

TEST(GeometricVerification, RejectsASceneThatIsUpsideDown)
{
	const auto query = randomRoom(10, 10, 4);
	const auto target = moved(query, CPose3D::FromXYZYawPitchRoll(0, 0, 0, 0, 0, M_PI));
	EXPECT_EQ(verifyGeometry(query, target, identityMatches(10)).outcome, Outcome::Refuted);
}

TEST(GeometricVerification, NeedsTheLeastNumberOfInliers)
{
	const auto query = fourObjects();
	GeometricVerificationOptions options;
	options.minInliers = 5;
	const auto result = verifyGeometry(query, query, identityMatches(4), options);
	EXPECT_EQ(result.outcome, Outcome::Refuted);
	EXPECT_EQ(result.reason, "only 4 of 4 objects fit one pose, needed are 5 and 50 %");
}

TEST(GeometricVerification, NeedsTheLeastShareOfTheQuery)
{
	// Five objects of a room are in the map, six are not.
	const auto query = randomRoom(11, 20, 6);
	auto target = query;
	for (std::size_t i = 5; i < 11; ++i) target.vertices[i].label = "other";
	const auto matches = identityMatches(5);
	EXPECT_EQ(verifyGeometry(query, target, matches).outcome, Outcome::Refuted);
	GeometricVerificationOptions options;
	options.minInlierShare = 0.45;
	EXPECT_EQ(verifyGeometry(query, target, matches, options).outcome, Outcome::Confirmed);
}

TEST(GeometricVerification, ADeskThatStandsTwiceIsAmbiguous)
{
	const auto desk = randomRoom(8, 8, 1);
	const auto target = united(desk, moved(desk, yawPose(10, 0, 0, M_PI)));
	const auto result = verifyGeometry(desk, target, identityMatches(8));
	EXPECT_EQ(result.outcome, Outcome::Ambiguous);
	EXPECT_DOUBLE_EQ(result.runnerUp, 1);
	EXPECT_THAT(result.reason, HasSubstr("100 %"));
}

TEST(GeometricVerification, ARivalThatExplainsHalfIsNoDanger)
{
	const auto desk = randomRoom(8, 8, 1);
	auto copy = moved(desk, yawPose(10, 0, 0, M_PI));
	for (std::size_t i = 0; i < 4; ++i) copy.vertices[i].label = "other";
	const auto result = verifyGeometry(desk, united(desk, copy), identityMatches(8));
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
	EXPECT_DOUBLE_EQ(result.runnerUp, 0.5);
}

TEST(GeometricVerification, ATurnOfASymmetricSceneIsARival)
{
	// Four chairs round a table: each quarter turn fits.
	const auto scene = complete(
		{vertex(0, "chair", 1, 0, 0.5), vertex(1, "chair", 0, 1, 0.5),
		 vertex(2, "chair", -1, 0, 0.5), vertex(3, "chair", 0, -1, 0.5),
		 vertex(4, "table", 0, 0, 0.7)});
	EXPECT_EQ(verifyGeometry(scene, scene, identityMatches(5)).outcome, Outcome::Ambiguous);
}

TEST(GeometricVerification, EmbeddingsResolveARepeatedDesk)
{
	auto desk = randomRoom(8, 8, 1);
	auto copy = moved(desk, yawPose(10, 0, 0, M_PI));
	for (auto& v : desk.vertices) v.embeddings = {{1, 0}};
	for (auto& v : copy.vertices) v.embeddings = {{0, 1}};
	const auto result = verifyGeometry(desk, united(desk, copy), identityMatches(8));
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
	EXPECT_EQ(result.runnerUp, 0);
}

TEST(GeometricVerification, RecoversThePoseFromNoisyCentres)
{
	std::mt19937 random(7);
	std::normal_distribution<double> noise(0, 0.05);
	const auto room = randomRoom(12, 5, 9);
	const auto T = yawPose(-2, 1, 0.1, 0.9);
	auto target = moved(room, T);
	for (auto& v : target.vertices)
		v.position += TPoint3D(noise(random), noise(random), noise(random));
	const auto matching = SpectralMatcher().match(room, target);
	const auto result = verifyGeometry(room, target, matching.matches);
	EXPECT_EQ(result.outcome, Outcome::Confirmed) << result.reason;
	// Three sigma of the mean of 12 centres; the room is about 2 m in radius.
	EXPECT_LT(
		result.T_target_query.composePoint({2.5, 2, 1})
			.distanceTo(T.composePoint(TPoint3D(2.5, 2, 1))),
		0.08);
	EXPECT_NEAR(result.T_target_query.yaw(), T.yaw(), 0.04);
	EXPECT_NEAR(result.rmse, 0.05 * std::sqrt(3.0), 0.04);
}

TEST(GeometricVerification, IsInvariantToYawAndTranslationOfTheQuery)
{
	const auto room = randomRoom(10, 4, 9), target = randomRoom(10, 4, 9);
	const auto turned = moved(room, yawPose(5, 6, 7, 2));
	const auto a = verifyGeometry(room, target, identityMatches(10));
	const auto b = verifyGeometry(turned, target, identityMatches(10));
	EXPECT_EQ(a.outcome, b.outcome);
	EXPECT_EQ(a.inliers, b.inliers);
	EXPECT_EQ(a.runnerUp, b.runnerUp);
}

TEST(GeometricVerification, DegenerateInputsAreRefutedWithAReason)
{
	const auto four = fourObjects();
	EXPECT_THAT(verifyGeometry({}, {}, {}).reason, HasSubstr("0 matches"));
	EXPECT_THAT(verifyGeometry(four, four, {{0, 0}}).reason, HasSubstr("1 matches"));
	// All in one vertical line: the yaw is open.
	const auto stack = complete(
		{vertex(0, "a", 1, 1, 0), vertex(1, "b", 1, 1, 1), vertex(2, "c", 1, 1, 2),
		 vertex(3, "d", 1, 1, 3)});
	const auto result = verifyGeometry(stack, stack, identityMatches(4));
	EXPECT_EQ(result.outcome, Outcome::Refuted);
	EXPECT_THAT(result.reason, HasSubstr("no two of the 4 matches agree"));
}
}  // namespace
