#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/CameraPath.h>
#include <semloop/simulation/Furnishing.h>

#include <cmath>

#include "CatalogFixture.h"

using namespace semloop;
using Eigen::Vector2d;
using testing::AllOf;
using testing::HasSubstr;

namespace
{
const LabelSet kLabels({"thing"});

ItemOptions item(const std::string& model, const std::string& place)
{
	ItemOptions options;
	options.label = "thing";
	options.models = {model};
	options.place = place;
	return options;
}

/** A room of 4 x 3 m without a door, the way along its left wall; the one catalogue model is a chair,
 *  0.4 x 0.5 x 0.9 m. */
class Furnishing : public testing::Test
{
protected:
	Furnishing()
	{
		scene_.file = "test.ini";
		scene_.items = {
			{"chair", item("Test#chair", "floor")},
			{"shelf", item("Test#chair", "wall")},
			{"lamp", item("Test#chair", "corner")},
			{"book", item("primitive:book", "top")}};
		addRoom("den", 0);
	}

	RoomOptions& addRoom(const std::string& name, double x, const std::string& width = "4")
	{
		RoomOptions room;
		room.corner = {std::to_string(x), "0"};
		room.size = {width, "3"};
		scene_.rooms.emplace_back(name, room);
		return scene_.rooms.back().second;
	}
	void put(const std::vector<std::string>& groups) { scene_.rooms[0].second.furniture = groups; }

	std::vector<SceneObject> furnish(uint64_t seed = 1)
	{
		const FurnitureCatalog catalog = fixture_.open();
		FurnitureModels models(catalog);
		return semloop::furnish(scene_, scene_.floorPlan(), way_, models, kLabels, seed);
	}
	template <class Error>
	std::string errorOf()
	{
		return messageOf<Error>([&] { furnish(); });
	}

	CatalogFixture fixture_;
	SceneDescription scene_;
	std::vector<Vector2d> way_ = splineThrough({{0.3, 0.3}, {0.3, 2.7}}, false);
};

Vector2d placeOf(const SceneObject& object)
{
	return {object.T_world_object.x(), object.T_world_object.y()};
}

/** Where its front looks. */
Vector2d frontOf(const SceneObject& object)
{
	const auto front = object.T_world_object.rotateVector({0, -1, 0});
	return {front.x, front.y};
}

/** Distance of the back, half a depth behind the middle, to the nearest wall behind it. */
double gapBehind(const SceneObject& object)
{
	const Vector2d back = placeOf(object) - 0.25 * frontOf(object), away = -frontOf(object);
	const double x = away.x() > 0 ? 4 - back.x() : back.x();
	const double y = away.y() > 0 ? 3 - back.y() : back.y();
	return std::abs(away.x()) > 0.5 ? x : y;
}
}  // namespace

TEST_F(Furnishing, APieceAtAWallHasItsBackThere)
{
	put({"shelf", "shelf", "shelf"});
	for (uint64_t seed = 1; seed <= 10; ++seed)
		for (const auto& shelf : furnish(seed)) EXPECT_NEAR(gapBehind(shelf), 0.02, 1e-9) << seed;
}

TEST_F(Furnishing, APieceInACornerTouchesTwoWalls)
{
	put({"lamp", "lamp"});
	for (uint64_t seed = 1; seed <= 10; ++seed)
		for (const auto& lamp : furnish(seed))
		{
			EXPECT_NEAR(gapBehind(lamp), 0.02, 1e-9) << seed;
			const Vector2d at = placeOf(lamp);
			const double x = std::min(at.x(), 4 - at.x()), y = std::min(at.y(), 3 - at.y());
			// Half of 0.4 and half of 0.5 m away from two walls, either way round.
			EXPECT_NEAR(std::min(x, y), 0.22, 1e-9) << seed;
			EXPECT_NEAR(std::max(x, y), 0.27, 1e-9) << seed;
		}
}

TEST_F(Furnishing, ThingsStandOnTheTopThatTheCatalogueGives)
{
	fixture_.model["dropOnTopElevation"] = "45";
	put({"chair + book"});
	const auto objects = furnish();
	ASSERT_EQ(objects.size(), 2u);
	EXPECT_EQ(objects[0].T_world_object.z(), 0);
	EXPECT_NEAR(objects[1].T_world_object.z(), 0.45, 1e-9);
	EXPECT_LT((placeOf(objects[1]) - placeOf(objects[0])).norm(), 0.2);
	EXPECT_EQ(objects[1].model.rfind("primitive:book#", 0), 0u);
}

TEST_F(Furnishing, ASpotSaysWhereOnTop)
{
	scene_.items["mouse"] = item("primitive:mouse", "top");
	scene_.items["mouse"].spot = {"1", "-1"};
	put({"chair + mouse"});
	for (uint64_t seed = 1; seed <= 10; ++seed)
	{
		const auto objects = furnish(seed);
		const auto spot = objects[1].T_world_object - objects[0].T_world_object;
		EXPECT_GT(spot.x(), 0.1) << "right, of 0.2 m";
		EXPECT_LT(spot.y(), -0.1) << "in front, of 0.25 m";
	}
}

TEST_F(Furnishing, WhatStandsAroundFacesTheMiddle)
{
	put({"chair > chair > chair > chair > chair"});
	for (uint64_t seed = 1; seed <= 5; ++seed)
	{
		const auto objects = furnish(seed);
		ASSERT_EQ(objects.size(), 5u);
		for (std::size_t i = 1; i < objects.size(); ++i)
		{
			const Vector2d inward = (placeOf(objects[0]) - placeOf(objects[i])).normalized();
			EXPECT_GT(frontOf(objects[i]).dot(inward), 0.9) << seed << " " << i;
		}
		EXPECT_GT(frontOf(objects[0]).dot(placeOf(objects[1]) - placeOf(objects[0])), 0.4)
			<< "the first is in front";
	}
}

TEST_F(Furnishing, TheWayStaysClear)
{
	put({"chair", "chair", "shelf", "shelf", "lamp"});
	for (uint64_t seed = 1; seed <= 10; ++seed)
		for (const auto& object : furnish(seed))
			for (const auto& place : way_)
				ASSERT_GT(
					distance({placeOf(object), {0.4, 0.5}, object.T_world_object.yaw()}, place),
					scene_.scene.pathClearance - 0.001);
}

TEST_F(Furnishing, TheSpaceBeforeADoorStaysClear)
{
	scene_.scene.doors = {"2 3.05 0.9"};
	put({"shelf", "shelf", "shelf", "shelf", "chair", "chair"});
	const Footprint before{{2, 3}, {0.9, 1.2}, 0};
	for (uint64_t seed = 1; seed <= 10; ++seed)
		for (const auto& object : furnish(seed))
			EXPECT_FALSE(
				overlap({placeOf(object), {0.4, 0.5}, object.T_world_object.yaw()}, before, 0));
}

TEST_F(Furnishing, TheSeedDecides)
{
	put({"chair", "shelf + book"});
	const auto first = furnish(3), again = furnish(3), other = furnish(4);
	for (std::size_t i = 0; i < first.size(); ++i)
	{
		EXPECT_EQ(first[i].T_world_object, again[i].T_world_object);
		EXPECT_EQ(first[i].model, again[i].model);
		EXPECT_EQ(first[i].id, i + 1);
	}
	EXPECT_GT((placeOf(first[0]) - placeOf(other[0])).norm(), 0);
}

TEST_F(Furnishing, AFullRoomSaysWhichGroupAndHowLarge)
{
	put(std::vector<std::string>(60, "chair"));
	EXPECT_THAT(
		errorOf<InputError>(), AllOf(
								   HasSubstr("test.ini: [room.den] furniture: 'chair'"),
								   HasSubstr("0.40 x 0.50 m"), HasSubstr("seed 1")));
}

TEST_F(Furnishing, NothingStandsOnWhatHasNoTop)
{
	fixture_.model["dropOnTopElevation"] = "-1";
	put({"shelf + book"});
	EXPECT_THAT(
		errorOf<UsageError>(),
		AllOf(HasSubstr("test.ini: [room.den]"), HasSubstr("Test#chair"), HasSubstr("'book'")));
	put({"shelf"});
	EXPECT_EQ(errorOf<UsageError>(), "");
}

TEST_F(Furnishing, WhatBelongsOnTopDoesNotStandOnTheFloor)
{
	put({"book"});
	EXPECT_THAT(errorOf<UsageError>(), AllOf(HasSubstr("'book'"), HasSubstr("place = top")));
}

TEST_F(Furnishing, WhatIsTooLargeForTheTopIsNamed)
{
	// A book has at least 15 x 20 cm, the top 40 x 50.
	put({"shelf + book"});
	EXPECT_EQ(errorOf<InputError>(), "");
	put({"shelf + book + book + book + book + book + book + book"});
	EXPECT_THAT(errorOf<InputError>(), HasSubstr("no room for book on top of Test#chair"));
}

TEST_F(Furnishing, ARoomLikeAnotherGetsTheSamePieces)
{
	put({"chair", "shelf + book"});
	addRoom("copy", 5).like = "den";
	const auto objects = furnish();
	ASSERT_EQ(objects.size(), 6u);
	for (int i = 0; i < 3; ++i)
	{
		const auto moved = mrpt::poses::CPose3D(5, 0, 0, 0, 0, 0) + objects[i].T_world_object;
		EXPECT_LT(moved.distanceTo(objects[i + 3].T_world_object), 1e-9);
		EXPECT_EQ(objects[i].mesh, objects[i + 3].mesh);
	}
}

TEST_F(Furnishing, ItsFurnitureStandsInNoWayAndNoDoorThere)
{
	put({"shelf", "shelf", "chair"});
	addRoom("copy", 5).like = "den";
	scene_.scene.doors = {"7 3.05 0.9"};
	way_ = splineThrough({{5.2, 1.5}, {8.8, 1.5}}, false);
	for (uint64_t seed = 1; seed <= 10; ++seed)
		for (const auto& object : furnish(seed))
		{
			const Footprint place{placeOf(object), {0.4, 0.5}, object.T_world_object.yaw()};
			EXPECT_FALSE(overlap(place, {{7, 3}, {0.9, 1.2}, 0}, 0));
			for (const auto& step : way_) ASSERT_GT(distance(place, step), 0.349);
		}
}

TEST_F(Furnishing, ACopyThatWouldStandInTheWayIsAnError)
{
	put({"chair"});
	addRoom("copy", 5).like = "den";
	// Up and down, 0.6 m apart: nowhere in the copy is there room for a chair.
	way_.clear();
	for (double x = 5.2; x < 9; x += 0.6)
		for (double y = 0; y <= 3; y += 0.02) way_.emplace_back(x, y);
	EXPECT_THAT(
		errorOf<InputError>(), AllOf(HasSubstr("[room.den]"), HasSubstr("same place in copy")));
}

TEST_F(Furnishing, LikeMustNameARoomOfTheSameSizeWithFurnitureOfItsOwn)
{
	put({"chair"});
	const auto errorWith = [&](const std::string& name, double x, const std::string& width,
							   const std::string& like, std::vector<std::string> own)
	{
		auto& room = addRoom(name, x, width);
		room.like = like;
		room.furniture = std::move(own);
		const auto message = errorOf<UsageError>();
		scene_.rooms.pop_back();
		return message;
	};
	EXPECT_THAT(errorWith("a", 5, "4", "attic", {}), HasSubstr("like = attic: no such room"));
	EXPECT_THAT(errorWith("a", 5, "3.5", "den", {}), HasSubstr("another size"));
	EXPECT_THAT(errorWith("a", 5, "4", "den", {"shelf"}), HasSubstr("furniture of its own"));
	EXPECT_THAT(errorWith("a", 5, "4", "a", {}), HasSubstr("copy itself"));
}
