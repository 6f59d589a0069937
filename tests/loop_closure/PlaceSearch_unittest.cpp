#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/PlaceSearch.h>

#include <cmath>
#include <random>

#include "GraphFixtures.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;
using testing::HasSubstr;

Places placesOf(
	const SemanticGraph& query, const SemanticGraph& target,
	const std::optional<PosePrior>& prior = {}, const PlaceSearchOptions& options = {})
{
	const GraphIndex index(target);
	return PlaceSearch(query, index, options).places(prior);
}

void expectNear(const CPose3D& a, const CPose3D& b, double metres, double radians)
{
	EXPECT_LT(a.distanceTo(b), metres) << a << " and " << b;
	EXPECT_LT(rotationAngle(a - b), radians) << a << " and " << b;
}

double normal(double squaredDistance, double sigma)
{
	return std::exp(-0.5 * squaredDistance / (sigma * sigma)) /
		   std::pow(2 * M_PI * sigma * sigma, 1.5);
}

/** A direction in space, the same for a seed. */
std::vector<float> look(unsigned seed, const std::vector<float>& base = {}, float change = 1)
{
	std::mt19937 random(seed);
	std::normal_distribution<float> gauss;
	std::vector<float> result = base.empty() ? std::vector<float>(16, 0) : base;
	float squared = 0;
	for (auto& value : result)
	{
		value += change * gauss(random) / 4;
		squared += value * value;
	}
	for (auto& value : result) value /= std::sqrt(squared);
	return result;
}

TEST(PlaceSearch, FindsTheQueryAndItsPose)
{
	const auto query = fourObjects();
	const auto T = yawPose(3, -1, 0.2, -2);
	const auto places = placesOf(query, moved(query, T));
	ASSERT_EQ(places.found.size(), 1u);
	EXPECT_TRUE(places.complete);
	EXPECT_EQ(places.found[0].matches, identityMatches(4));
	expectNear(places.found[0].T_target_query, T, 1e-5, 1e-5);
	EXPECT_DOUBLE_EQ(places.found[0].sigma, PlaceSearchOptions().minSigma);
}

TEST(PlaceSearch, TheEvidenceIsTheFormulas)
{
	// Three objects of three labels, exactly in their places, in a map with two more.
	const auto query = complete(
		{vertex(0, "chair", -1, 0, 0.5), vertex(1, "table", 1, 0, 0.5),
		 vertex(2, "lamp", 0, 1.5, 1.5)});
	auto target = query;
	target.vertices.push_back(vertex(3, "sofa", 6, 0, 0));
	target.vertices.push_back(vertex(4, "sofa", 6, 4, 0));
	PlaceSearchOptions options;
	options.minSigma = options.maxSigma = 0.05;
	const auto place = placesOf(query, target, {}, options).found.at(0);

	// Centroid (0, 0.5): mean squared distance (1.25 + 1.25 + 1) / 3; a metre high.
	const double spread = 3.5 / 3, volume = 2 * M_PI * spread * 1.0;
	// One of five objects, each label counted once more, and one label more than there are.
	const double share = 2.0 / (5 + 4 + 1);
	const double kernel =
		(1 - options.badCentreShare) * normal(0, 0.05) + options.badCentreShare * normal(0, 0.15);
	const double match =
		std::log(options.reobservedShare / (1 - options.reobservedShare) * volume * kernel) +
		std::log(options.labelAccuracy / share);
	const double area = 7 * 4;
	const double pose =
		-std::log(area * 1.0 * 2 * M_PI) +
		std::log(std::pow(2 * M_PI, 2) * std::pow(0.05, 4) / (3 * 3 * std::sqrt(spread)));
	EXPECT_NEAR(place.evidence, 3 * match + pose, 1e-4);
	EXPECT_NEAR(place.yawSigma, 0.05 / std::sqrt(3 * spread), 1e-6);
}

TEST(PlaceSearch, FindsANoisyLocalMapInARoomAndItsNoise)
{
	for (unsigned seed = 0; seed < 10; ++seed)
	{
		std::mt19937 random(seed);
		std::normal_distribution<double> noise(0, 0.1);
		const auto room = randomRoom(40, 10, seed);
		SemanticGraph query;
		for (std::size_t i = 0; i < 12; ++i) query.vertices.push_back(room.vertices[i]);
		const auto T = yawPose(2, 1, 0.3, 0.4 * seed);
		query = moved(query, CPose3D() - T);
		for (auto& v : query.vertices)
			v.position += TPoint3D(noise(random), noise(random), noise(random));
		const auto places = placesOf(query, room);
		ASSERT_FALSE(places.found.empty()) << seed;
		const auto& best = places.found[0];
		expectNear(best.T_target_query, T, 0.3, 0.15);
		EXPECT_GE(best.sigma, 0.07) << seed;
		EXPECT_LE(best.sigma, 0.15) << seed;
		for (const auto& match : best.matches) EXPECT_EQ(match.query, match.target) << seed;
		EXPECT_GE(best.matches.size(), 9u) << seed;
	}
}

TEST(PlaceSearch, TheMirrorImageIsAnotherArrangement)
{
	for (unsigned seed = 0; seed < 10; ++seed)
	{
		const auto room = randomRoom(12, 12, seed);
		auto mirrored = room;
		for (auto& v : mirrored.vertices) v.position.x = -v.position.x;
		const double right = placesOf(room, room).found.at(0).evidence;
		const auto wrong = placesOf(mirrored, room).found;
		const double mirror = wrong.empty() ? 0 : wrong[0].evidence;
		EXPECT_LT(mirror, 0.4 * right) << seed;
	}
}

TEST(PlaceSearch, DoesNotDependOnTheQuerysFrameNorOnOrder)
{
	const auto room = randomRoom(30, 8, 3);
	SemanticGraph query;
	for (std::size_t i = 0; i < 9; ++i) query.vertices.push_back(room.vertices[i]);
	const double evidence = placesOf(query, room).found.at(0).evidence;
	const auto turned = placesOf(moved(query, yawPose(20, -7, 3, 1.2)), room).found.at(0);
	EXPECT_NEAR(turned.evidence, evidence, 1e-3);
	const auto other = placesOf(reordered(query, {8, 3, 5, 1, 0, 7, 2, 6, 4}), room).found.at(0);
	EXPECT_NEAR(other.evidence, evidence, 1e-3);
	EXPECT_EQ(other.matches.size(), 9u);
}

TEST(PlaceSearch, ACopyOfTheDeskIsARivalAndAPriorDecides)
{
	const auto desk = randomRoom(6, 6, 1);
	const auto away = yawPose(12, 3, 0, 1);
	const auto target = united(desk, moved(desk, away));
	const auto places = placesOf(desk, target).found;
	ASSERT_GE(places.size(), 2u);
	EXPECT_NEAR(places[0].evidence, places[1].evidence, 1e-3);
	const std::vector<Place> rivals(places.begin() + 1, places.end());
	EXPECT_LT(probabilityOf(places[0], 6, rivals, {}), 0.5);
	EXPECT_GT(probabilityOf(places[0], 6, {}, {}), 0.99);

	PosePrior prior;
	for (const auto& T : {CPose3D(), away})
	{
		prior.T_target_query = T + yawPose(0.3, -0.2, 0.05, 0.05);
		const auto claimed = placesOf(desk, target, prior).found;
		ASSERT_GE(claimed.size(), 2u) << "a prior hides nothing";
		// The prior's yaw is 0.05 rad off, and weighs what (0.03 m / R sqrt(6))^2 is of 0.01 rad^2.
		expectNear(claimed[0].T_target_query, T, 1e-3, 1e-3);
		EXPECT_LT(claimed[0].priorSigmas, 1);
		EXPECT_GT(claimed[0].evidence, claimed[1].evidence + 10);
	}
}

TEST(PlaceSearch, LooksTellCopiesApartAndFindMislabelledObjects)
{
	auto desk = randomRoom(6, 6, 1), copy = desk;
	for (unsigned i = 0; i < 6; ++i)
	{
		desk.vertices[i].embeddings = {look(i)};
		copy.vertices[i].embeddings = {look(100 + i)};
	}
	const auto target = united(moved(copy, yawPose(9, 0, 0, 2)), desk);
	auto query = desk;
	for (unsigned i = 0; i < 6; ++i) query.vertices[i].embeddings = {look(200 + i, look(i), 0.3f)};
	query.vertices[0].label = "mistaken";
	const auto places = placesOf(query, target).found;
	ASSERT_FALSE(places.empty());
	expectNear(places[0].T_target_query, CPose3D(), 1e-4, 1e-4);
	EXPECT_EQ(places[0].matches.size(), 6u);
	EXPECT_EQ(places[0].matches[0].target, 6u);
	const double rival = places.size() > 1 ? places[1].evidence : 0;
	EXPECT_GT(places[0].evidence, rival + 10);
}

TEST(PlaceSearch, MatchesThatAreMostlyWrongStillProposeThePlace)
{
	const auto room = randomRoom(20, 5, 7);
	auto matches = identityMatches(20);
	for (std::size_t i = 0; i < 12; ++i) matches[i].target = 19 - i;
	const GraphIndex index(room);
	const auto places = PlaceSearch(room, index).placesOf(matches).found;
	ASSERT_FALSE(places.empty());
	expectNear(places[0].T_target_query, CPose3D(), 1e-4, 1e-4);
	EXPECT_EQ(places[0].matches.size(), 20u);
	EXPECT_TRUE(PlaceSearch(room, index).placesOf({{0, 0}}).found.empty());
}

TEST(PlaceSearch, NothingInCommonIsNoPlace)
{
	EXPECT_TRUE(placesOf({}, fourObjects()).found.empty());
	EXPECT_TRUE(placesOf(fourObjects(), {}).found.empty());
	const auto strangers = complete({vertex(0, "boat", 0, 0, 0), vertex(1, "kite", 1, 0, 0)});
	EXPECT_TRUE(placesOf(strangers, fourObjects()).found.empty());
	// One above the other: their yaw is open.
	const auto pile = complete({vertex(0, "box", 0, 0, 0), vertex(1, "cup", 0, 0, 1)});
	EXPECT_TRUE(placesOf(pile, pile).found.empty());
}

TEST(PlaceSearch, HalfOfADeskIsEnoughAmongThousandsOfObjects)
{
	std::mt19937 random(3);
	std::normal_distribution<double> noise(0, 0.06);
	std::uniform_real_distribution<double> unit(0, 1);
	const auto anywhere = [&](ObjectId id, double size)
	{
		return vertex(
			id, "label" + std::to_string(int(20 * unit(random))), size * unit(random),
			size * unit(random), 2 * unit(random));
	};
	SemanticGraph target;
	for (ObjectId id = 0; id < 5000; ++id) target.vertices.push_back(anywhere(id, 70));
	const GraphIndex index(target);
	for (int trial = 0; trial < 10; ++trial)
	{
		// All of 2.5 m round a place: half as they are, half of them now something else.
		const double x = 10 + 50 * unit(random), y = 10 + 50 * unit(random);
		const auto T = yawPose(x, y, 0, 6 * unit(random));
		SemanticGraph query;
		for (const auto& v : target.vertices)
		{
			if (std::hypot(v.position.x - x, v.position.y - y) > 2.5) continue;
			const auto before = (-T).composePoint(v.position);
			auto changed = anywhere(v.id, 1);
			changed.position = before;
			auto same = v;
			same.position = before + TPoint3D(noise(random), noise(random), noise(random));
			query.vertices.push_back(query.vertices.size() % 2 ? changed : same);
		}
		ASSERT_GE(query.vertices.size(), 12u);
		const auto places = PlaceSearch(query, index).places();
		ASSERT_FALSE(places.found.empty());
		EXPECT_LT(places.found[0].T_target_query.distanceTo(T), 0.2) << "trial " << trial;
	}
}

TEST(PlaceSearch, AQueryThatIsTurnedHasTheSamePlacesInALargeMap)
{
	// So many candidates that not all of their pairs are tried.
	std::mt19937 random(5);
	std::uniform_real_distribution<double> unit(0, 1);
	SemanticGraph target, query;
	for (ObjectId id = 0; id < 1600; ++id)
		target.vertices.push_back(vertex(
			id, "label" + std::to_string(id % 8), 40 * unit(random), 40 * unit(random),
			2 * unit(random)));
	for (const auto& v : target.vertices)
		if (std::hypot(v.position.x - 20, v.position.y - 20) < 2.2) query.vertices.push_back(v);
	ASSERT_GE(query.vertices.size(), 12u);
	const auto expected = placesOf(query, target).found;
	ASSERT_FALSE(expected.empty());
	for (const double yaw : {0.7, 2.0, -2.6})
	{
		const auto places = placesOf(moved(query, yawPose(3, -8, 0, yaw)), target).found;
		ASSERT_EQ(places.size(), expected.size());
		for (std::size_t i = 0; i < places.size(); ++i)
			EXPECT_NEAR(places[i].evidence, expected[i].evidence, 0.01);
	}
}

TEST(PlaceSearch, MatchesOneAboveTheOtherProposeNothing)
{
	const auto pile = complete({vertex(0, "box", 0, 0, 0), vertex(1, "cup", 0, 0, 1)});
	auto apart = pile;
	apart.vertices[1].position.x = 0.4;
	const GraphIndex index(apart);
	EXPECT_TRUE(PlaceSearch(pile, index).placesOf(identityMatches(2)).found.empty());
}

TEST(PlaceSearch, ACentreThatWasSeenFromOneSideMayBeFarOff)
{
	// Eight objects fit exactly; a ninth is 0.45 m off.
	auto room = randomRoom(9, 4, 11);
	auto query = room;
	query.vertices[4].position.x += 0.45;
	const auto all = placesOf(query, room).found.at(0);
	query.vertices[4].completeness = 0;
	query.vertices[4].extent.emplace(0.4, 1.2, 0.5);
	room.vertices[4].completeness = 0.2;
	const auto part = placesOf(query, room).found.at(0);
	EXPECT_EQ(all.matches.size(), 8u);
	EXPECT_EQ(part.matches.size(), 9u);
	EXPECT_GT(part.evidence, all.evidence);
	// It does not bend the pose.
	expectNear(part.T_target_query, CPose3D(), 0.02, 0.02);
	// What was seen all round is as if nothing was said.
	for (auto& v : room.vertices) v.completeness = 1;
	query.vertices[4].completeness = {};
	EXPECT_EQ(placesOf(query, room).found.at(0).evidence, all.evidence);
}

TEST(PlaceSearch, ThousandsOfLookalikesEndTheSearchBeforeItIsComplete)
{
	SemanticGraph field;
	for (int i = 0; i < 5000; ++i)
		field.vertices.push_back(vertex(ObjectId(i), "chair", 0.7 * (i % 71), 0.7 * (i / 71), 0.4));
	const auto places = placesOf(field, field);
	EXPECT_FALSE(places.complete);
}

TEST(PlaceSearch, WhatIsNotFiniteOrOfAnotherNetworkIsNamed)
{
	auto graph = fourObjects();
	graph.vertices[2].position.y = std::nan("");
	EXPECT_THAT(messageOf<InputError>([&] { GraphIndex index(graph); }), HasSubstr("object 12"));
	graph = fourObjects();
	graph.vertices[1].embeddings = {{1, std::nanf("")}};
	EXPECT_THAT(messageOf<InputError>([&] { GraphIndex index(graph); }), HasSubstr("object 11"));
	graph.vertices[1].embeddings = {{1, 0}};
	graph.vertices[3].embeddings = {{1, 0, 0}};
	EXPECT_THAT(
		messageOf<InputError>([&] { GraphIndex index(graph); }),
		testing::AllOf(HasSubstr("object 13"), HasSubstr("3"), HasSubstr("2")));
	graph.vertices[3].embeddings.clear();
	auto other = fourObjects();
	for (auto& v : other.vertices) v.embeddings = {{1, 0, 0}};
	const GraphIndex index(graph);
	EXPECT_THAT(
		messageOf<InputError>([&] { PlaceSearch search(other, index); }),
		HasSubstr("embeddings of 3 numbers against 2"));
}
}  // namespace
