#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/PlaceRecognizer.h>

#include <cmath>
#include <random>

#include "GraphFixtures.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using Decision = LoopVerdict::Decision;
using testing::HasSubstr;

LoopVerdict recognized(
	const SemanticGraph& query, const SemanticGraph& target,
	const std::string& matcher = "pairwise", const std::optional<PosePrior>& prior = {})
{
	PlaceRecognizerOptions options;
	options.matcher = matcher;
	return PlaceRecognizer(options).recognize(query, target, GraphIndex(target), prior);
}

class EveryMatcher : public testing::TestWithParam<std::string>
{
};

TEST_P(EveryMatcher, AcceptsADriftedCopyByItsIds)
{
	const auto query = randomRoom(10, 8, 2);
	const auto T = yawPose(0.4, -0.3, 0.1, 0.2);
	auto target = moved(query, T);
	for (auto& v : target.vertices) v.id += 100;
	const auto verdict = recognized(query, target, GetParam());
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	ASSERT_EQ(verdict.matches.size(), 10u);
	for (const auto& [from, to] : verdict.matches) EXPECT_EQ(to, from + 100);
	EXPECT_TRUE(verdict.hasPose);
	EXPECT_LT(verdict.T_target_query.distanceTo(T), 1e-4);
	EXPECT_EQ(verdict.queryObjects, 10u);
}

TEST_P(EveryMatcher, RejectsWithAReasonWhatHasNothingToMatch)
{
	const auto room = randomRoom(10, 8, 2);
	SemanticGraph one;
	one.vertices.push_back(room.vertices[0]);
	const SemanticGraph none;
	for (const auto& [query, target] :
		 {std::pair{none, room}, {room, none}, {one, room}, {room, one}})
	{
		const auto verdict = recognized(query, target, GetParam());
		EXPECT_EQ(verdict.decision, Decision::Rejected);
		EXPECT_THAT(verdict.reason, HasSubstr("needs two"));
		EXPECT_FALSE(verdict.hasPose);
	}
}

INSTANTIATE_TEST_SUITE_P(
	PlaceRecognizer, EveryMatcher, testing::ValuesIn(PlaceRecognizer::matcherNames()),
	[](const auto& testInfo)
	{
		std::string name = testInfo.param;
		for (char& c : name)
			if (c == '-') c = '_';
		return name;
	});

TEST(PlaceRecognizer, AnotherBuildingIsRejectedWithTheNumbers)
{
	int rejected = 0;
	for (unsigned seed = 0; seed < 20; ++seed)
	{
		const auto verdict = recognized(randomRoom(10, 8, seed), randomRoom(20, 8, 1000 + seed));
		EXPECT_NE(verdict.decision, Decision::Accepted) << verdict.reason;
		rejected += verdict.decision == Decision::Rejected;
		EXPECT_THAT(verdict.reason, testing::ContainsRegex("of 10 objects fit|no two of the 10"));
	}
	EXPECT_GE(rejected, 18);
}

TEST(PlaceRecognizer, ADeskThatStandsTwiceIsAmbiguousUntilAPriorTells)
{
	const auto desk = randomRoom(7, 7, 5);
	const auto away = yawPose(30, 0, 0, 0.5);
	const auto target = united(desk, moved(desk, away));
	for (const char* matcher : {"pairwise", "spectral-verified"})
	{
		const auto verdict = recognized(desk, target, matcher);
		EXPECT_EQ(verdict.decision, Decision::Ambiguous) << verdict.reason;
		EXPECT_NEAR(verdict.runnerUp.value(), 1, 1e-3);
		EXPECT_LT(verdict.probability, 0.5);
	}
	PosePrior prior;
	prior.T_target_query = away;
	const auto verdict = recognized(desk, target, "pairwise", prior);
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_LT(verdict.T_target_query.distanceTo(away), 1e-3);
}

TEST(PlaceRecognizer, AnObjectThatWasMovedIsNoMatch)
{
	const auto query = randomRoom(8, 8, 1);
	const auto T = yawPose(0.5, 0.4, 0, 0.3);
	auto target = moved(query, T);
	target.vertices[5].position += mrpt::math::TPoint3D(2, 0, 0);
	const auto verdict = recognized(query, target);
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_EQ(verdict.matches.size(), 7u);
	for (const auto& match : verdict.matches) EXPECT_NE(match.first, query.vertices[5].id);
	EXPECT_LT(verdict.T_target_query.distanceTo(T), 1e-4);
	EXPECT_NEAR(verdict.centreRmse.value(), 0, 1e-4);
}

TEST(PlaceRecognizer, AMirroredOrInvertedRoomIsAnotherRoom)
{
	// All distances are those of the original: only a motion that keeps gravity can tell.
	for (unsigned seed = 0; seed < 20; ++seed)
	{
		const auto query = randomRoom(10, 10, seed);
		auto mirrored = query, inverted = query;
		for (auto& v : mirrored.vertices) v.position.x = -v.position.x;
		for (auto& v : inverted.vertices) v.position = {v.position.x, -v.position.y, -v.position.z};
		for (const auto& target : {mirrored, inverted})
		{
			const auto verdict = recognized(query, target);
			EXPECT_NE(verdict.decision, Decision::Accepted) << seed << ": " << verdict.reason;
		}
	}
}

TEST(PlaceRecognizer, AWallIsItsOwnMirrorImageAndStillAPlace)
{
	const auto wall = complete(
		{vertex(0, "lamp", 0, 0, 1.2), vertex(1, "monitor", 0.7, 0, 0.9),
		 vertex(2, "monitor", 1.4, 0, 0.9), vertex(3, "printer", 2.5, 0, 0.8)});
	const auto T = yawPose(1, 2, 0, 1);
	const auto verdict = recognized(wall, moved(wall, T));
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_LT(verdict.T_target_query.distanceTo(T), 1e-4);
}

TEST(PlaceRecognizer, ATurnOfASymmetricPlaceIsARival)
{
	// Four chairs round a table: each quarter turn fits.
	const auto scene = complete(
		{vertex(0, "chair", 1, 0, 0.5), vertex(1, "chair", 0, 1, 0.5),
		 vertex(2, "chair", -1, 0, 0.5), vertex(3, "chair", 0, -1, 0.5),
		 vertex(4, "table", 0, 0, 0.7)});
	const auto verdict = recognized(scene, scene);
	EXPECT_EQ(verdict.decision, Decision::Ambiguous) << verdict.reason;
	EXPECT_NEAR(verdict.runnerUp.value(), 1, 1e-6);
	// Which of the four, odometry can tell.
	const auto known = recognized(scene, scene, "pairwise", PosePrior{});
	EXPECT_EQ(known.decision, Decision::Accepted) << known.reason;
	EXPECT_NEAR(known.T_target_query.yaw(), 0, 1e-6);
}

TEST(PlaceRecognizer, EmbeddingsTellARepeatedDesk)
{
	auto desk = randomRoom(8, 8, 1);
	auto copy = moved(desk, yawPose(10, 0, 0, M_PI));
	for (auto& v : desk.vertices) v.embeddings = {{1, 0}};
	for (auto& v : copy.vertices) v.embeddings = {{0, 1}};
	const auto verdict = recognized(desk, united(desk, copy));
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_LT(verdict.T_target_query.distanceTo(yawPose(0, 0, 0, 0)), 1e-4);
}

TEST(PlaceRecognizer, NoisyCentresGiveThePoseOfTheirMean)
{
	std::mt19937 random(7);
	std::normal_distribution<double> noise(0, 0.05);
	const auto room = randomRoom(12, 5, 9);
	const auto T = yawPose(-2, 1, 0.1, 0.9);
	auto target = moved(room, T);
	for (auto& v : target.vertices)
		v.position += mrpt::math::TPoint3D(noise(random), noise(random), noise(random));
	const auto verdict = recognized(room, target);
	ASSERT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	// Three sigma of the mean of 12 centres; the room is about 2 m in radius.
	const mrpt::math::TPoint3D middle(2.5, 2, 1);
	EXPECT_LT((verdict.T_target_query.composePoint(middle) - T.composePoint(middle)).norm(), 0.08);
	EXPECT_NEAR(verdict.T_target_query.yaw(), T.yaw(), 0.04);
	EXPECT_NEAR(verdict.centreRmse.value(), 0.05 * std::sqrt(3.0), 0.04);
}

TEST(PlaceRecognizer, WhereTheQueryBelievesToBeChangesNothing)
{
	const auto room = randomRoom(10, 4, 9);
	const auto a = recognized(room, room);
	const auto b = recognized(moved(room, yawPose(5, 6, 7, 2)), room);
	EXPECT_EQ(a.decision, b.decision);
	EXPECT_EQ(a.matches, b.matches);
	EXPECT_NEAR(a.evidence.value(), b.evidence.value(), 0.01);
	EXPECT_NEAR(a.probability, b.probability, 1e-3);
}

TEST(PlaceRecognizer, AStackLeavesTheYawOpen)
{
	const auto stack = complete(
		{vertex(0, "a", 1, 1, 0), vertex(1, "b", 1, 1, 0.4), vertex(2, "c", 1, 1, 0.8),
		 vertex(3, "d", 1, 1, 1.2)});
	const auto verdict = recognized(stack, stack);
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_EQ(verdict.reason, "no two of the 4 objects are in the map at their distance");
}

TEST(PlaceRecognizer, APlaceFarFromThePriorIsNotAccepted)
{
	const auto desk = fourObjects();
	PosePrior prior;
	prior.T_target_query = yawPose(0.5, 0.5, 0, 0.1);
	EXPECT_EQ(recognized(desk, desk, "pairwise", prior).decision, Decision::Accepted);
	prior.T_target_query = yawPose(120, 0, 0, 0);
	const auto verdict = recognized(desk, desk, "pairwise", prior);
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_THAT(verdict.reason, HasSubstr("standard deviations from the prior, allowed are 5.0"));
	EXPECT_TRUE(verdict.hasPose);
}

TEST(PlaceRecognizer, APriorWiderThanTheMapSaysWhatNoPriorSays)
{
	const auto room = randomRoom(10, 8, 2);
	const auto target = moved(room, yawPose(0.4, -0.3, 0.1, 0.2));
	PosePrior prior;
	prior.sigmaXY = prior.sigmaZ = 30;
	prior.sigmaYaw = 5;
	const auto vague = recognized(room, target, "pairwise", prior), none = recognized(room, target);
	EXPECT_DOUBLE_EQ(vague.evidence.value(), none.evidence.value());
	EXPECT_EQ(vague.decision, Decision::Accepted);
	EXPECT_EQ(vague.reason, none.reason);
}

TEST(PlaceRecognizer, APlaceFarFromThePriorIsRefusedUnlessAnyDistanceWillDo)
{
	const auto room = randomRoom(10, 8, 2);
	const auto target = moved(room, yawPose(0.6, 0, 0, 0));
	PosePrior prior;
	prior.sigmaXY = 0.1;
	EXPECT_THAT(
		recognized(room, target, "pairwise", prior).reason, HasSubstr("6.0 standard deviations"));
	PlaceRecognizerOptions options;
	options.maxPriorSigmas = 0;
	EXPECT_EQ(
		PlaceRecognizer(options).recognize(room, GraphIndex(target), prior).decision,
		Decision::Accepted);
}

TEST(PlaceRecognizer, APlaceIsWeighedByThePriorOfItsOwnObjects)
{
	// Two rooms alike, 3 m apart: the query is the first, and has drifted by 0.6 m towards the second.
	const auto room = randomRoom(8, 2, 3);
	auto map = moved(room, yawPose(-0.6, 0, 0, 0));
	const auto other = moved(room, yawPose(2.4, 0, 0, 0));
	for (auto v : other.vertices)
	{
		v.id += 100;
		map.vertices.push_back(v);
	}
	PosePrior wide;  // since the oldest, which is somewhere else
	wide.sigmaXY = 3;
	wide.sigmaYaw = 0.5;
	const PlaceRecognizer recognizer;
	const GraphIndex index(map);
	EXPECT_EQ(recognizer.recognize(room, index, wide).decision, Decision::Ambiguous);
	// The second room was seen a moment ago, the first one long before.
	const auto priorOf = [&](const std::vector<ObjectId>& objects)
	{
		PosePrior prior = wide;
		if (objects.front() >= 100) prior.sigmaXY = prior.sigmaYaw = 0.1;
		return prior;
	};
	const auto verdict = recognizer.recognize(room, index, wide, priorOf);
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_LT(verdict.matches.front().second, 100u);
	EXPECT_NEAR(verdict.T_target_query.x(), -0.6, 0.01);
	// If both were, neither would do.
	const auto none = recognizer.recognize(
		room, index, wide,
		[](const auto&)
		{
			PosePrior prior;
			prior.sigmaXY = prior.sigmaYaw = 0.05;
			return prior;
		});
	EXPECT_EQ(none.decision, Decision::Rejected) << none.reason;
}

TEST(PlaceRecognizer, PairsOfCandidatesNeedTheIndexOnlyMatchersTheGraph)
{
	const auto room = randomRoom(10, 8, 2);
	EXPECT_EQ(
		PlaceRecognizer().recognize(room, GraphIndex(room)).reason, recognized(room, room).reason);
	PlaceRecognizerOptions options;
	options.matcher = "clique";
	EXPECT_THROW(PlaceRecognizer(options).recognize(room, GraphIndex(room)), std::logic_error);
}

TEST(PlaceRecognizer, APriorThatIsNoneIsNamed)
{
	const auto room = fourObjects();
	for (const double sigma : {0.0, -1.0, std::nan(""), double(INFINITY)})
	{
		PosePrior prior;
		prior.sigmaYaw = sigma;
		EXPECT_THAT(
			messageOf<InputError>([&] { recognized(room, room, "pairwise", prior); }),
			HasSubstr("prior: its standard deviations are 0.8 m, 0.1 m and"));
	}
	PosePrior nowhere;
	nowhere.T_target_query.y(std::nan(""));
	EXPECT_THAT(
		messageOf<InputError>([&] { recognized(room, room, "pairwise", nowhere); }),
		HasSubstr("prior: its pose is not finite"));
}

TEST(PlaceRecognizer, AYawThatIsOpenIsAmbiguous)
{
	// Within 0.2 m of each other, measured as well as min_sigma says.
	const auto cluster = complete(
		{vertex(0, "cup", 0, 0, 1), vertex(1, "plate", 0.26, 0, 1), vertex(2, "fork", 0, 0.26, 1),
		 vertex(3, "vase", 0.26, 0.2, 1.2)});
	const auto verdict = recognized(cluster, cluster);
	EXPECT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	PlaceRecognizerOptions options;
	options.maxYawSigma = 0.05;
	const auto strict = PlaceRecognizer(options).recognize(cluster, cluster, GraphIndex(cluster));
	EXPECT_EQ(strict.decision, Decision::Ambiguous);
	EXPECT_THAT(strict.reason, HasSubstr("yaw is uncertain by 0.0"));
}

TEST(PlaceRecognizer, ThePublishedMatcherTakesHalfOfTheEdgesForALoop)
{
	// Five of ten objects are elsewhere: 10 of 45 edges are left.
	const auto query = randomRoom(10, 10, 4);
	auto target = query;
	for (std::size_t i = 0; i < 5; ++i)
		target.vertices[i].position.x += 10 * double((i + 1) * (i + 1));
	const auto verdict = recognized(query, target, "spectral");
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_NEAR(verdict.matchedEdgeShare.value(), 10.0 / 45, 1e-9);
	EXPECT_THAT(verdict.reason, HasSubstr("22 % of the 45 edges"));
	EXPECT_EQ(recognized(query, target).decision, Decision::Accepted);
}

TEST(PlaceRecognizer, AMatcherByItsClassNameProposesPlaces)
{
	const auto query = randomRoom(10, 8, 2);
	const auto target = moved(query, yawPose(0.4, -0.3, 0.1, 0.2));
	const auto named = recognized(query, target, "semloop::CliqueMatcher");
	const auto known = recognized(query, target, "clique");
	EXPECT_EQ(named.decision, Decision::Accepted);
	EXPECT_EQ(named.reason, known.reason);
	EXPECT_EQ(named.candidates.size(), 10u);
}

TEST(PlaceRecognizer, AnUnknownMatcherIsWrongUsage)
{
	PlaceRecognizerOptions options;
	options.matcher = "magic";
	EXPECT_THAT(
		messageOf<UsageError>([&] { PlaceRecognizer recognizer(options, "a.ini: [b] matcher"); }),
		testing::AllOf(
			testing::StartsWith("a.ini: [b] matcher = magic: not a registered "),
			HasSubstr("semloop::CliqueMatcher"),
			HasSubstr("pairwise, spectral-verified, clique, random-walk, histogram, spectral")));
}
}  // namespace
