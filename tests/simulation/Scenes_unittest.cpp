// What config_ini/scenes promise, with the furniture of the package sweethome3d-furniture.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "DescribedScenes.h"

using namespace semloop;
using Eigen::Vector2d;

namespace
{
constexpr double kBeforeDoor = 0.6;  // [m]
constexpr double kTolerance = 1e-3;  // meshes have float corners [m]

/** The upright box that a piece fills. */
struct Solid
{
	Footprint footprint;
	double bottom = 0, top = 0;  // [m]
};

Solid solidOf(const SceneObject& object)
{
	const Bounds bounds = boundsOf(*object.mesh);
	const Eigen::Vector3d middle = (bounds.minimum + bounds.maximum).cast<double>() / 2;
	const auto center = object.T_world_object.composePoint({middle.x(), middle.y(), middle.z()});
	Solid solid;
	solid.footprint = {
		{center.x, center.y}, bounds.size().head<2>().cast<double>(), object.T_world_object.yaw()};
	solid.bottom = object.T_world_object.z() + bounds.minimum.z();
	solid.top = object.T_world_object.z() + bounds.maximum.z();
	return solid;
}

/** Height above the floor at which things stand on it. */
double shelfOf(const SceneObject& object)
{
	const auto entry = catalog().entries().find(object.model);
	return entry == catalog().entries().end() ? solidOf(object).top : entry->second.top;
}

/** What an object stands on; null: the floor, or nothing. */
const SceneObject* supportOf(const SceneObject& object, const Scene& scene)
{
	if (object.T_world_object.z() == 0) return nullptr;
	const Vector2d place(object.T_world_object.x(), object.T_world_object.y());
	for (const auto& other : scene.objects)
		if (other.id != object.id && other.T_world_object.z() == 0 &&
			distance(solidOf(other).footprint, place) == 0 &&
			std::abs(shelfOf(other) - object.T_world_object.z()) < kTolerance)
			return &other;
	return nullptr;
}

bool intersect(const Solid& a, const Solid& b)
{
	return a.top > b.bottom + kTolerance && b.top > a.bottom + kTolerance &&
		   overlap(a.footprint, b.footprint, -kTolerance);
}

std::string nameOf(const SceneObject& object)
{
	return std::to_string(object.id) + " " + object.model;
}

class Scenes : public testing::TestWithParam<std::string>
{
protected:
	void SetUp() override
	{
		if (!hasFurniture()) GTEST_SKIP() << "sweethome3d-furniture is not installed";
		description_ = describe(GetParam());
		for (uint64_t seed = 1; seed <= kSeeds; ++seed)
			built_.push_back(buildScene(description_, catalog(), seed));
	}
	SceneDescription description_;
	std::vector<BuiltScene> built_;
};
}  // namespace

TEST_P(Scenes, NoTwoPiecesIntersect)
{
	for (const auto& built : built_)
		for (const auto& a : built.scene.objects)
			for (const auto& b : built.scene.objects)
			{
				if (b.id >= a.id || supportOf(a, built.scene) == &b) continue;
				EXPECT_FALSE(intersect(solidOf(a), solidOf(b))) << nameOf(a) << ", " << nameOf(b);
			}
}

TEST_P(Scenes, EveryPieceStandsOnTheFloorOrOnAnother)
{
	for (const auto& built : built_)
		for (const auto& object : built.scene.objects)
		{
			EXPECT_NEAR(solidOf(object).bottom, object.T_world_object.z(), kTolerance);
			if (object.T_world_object.z() == 0) continue;
			EXPECT_NE(supportOf(object, built.scene), nullptr) << nameOf(object);
		}
}

TEST_P(Scenes, EveryPieceIsInsideOneRoom)
{
	for (const auto& built : built_)
		for (const auto& object : built.scene.objects)
		{
			const auto corners = solidOf(object).footprint.corners();
			const auto holds = [&](const Room& room)
			{
				return std::all_of(
					corners.begin(), corners.end(),
					[&](const Vector2d& corner)
					{ return distance(room.footprint(), corner) < kTolerance; });
			};
			const auto& rooms = built.plan.rooms();
			EXPECT_TRUE(std::any_of(rooms.begin(), rooms.end(), holds)) << nameOf(object);
			EXPECT_LT(solidOf(object).top, description_.scene.height) << nameOf(object);
		}
}

TEST_P(Scenes, TheWayAndTheDoorsAreClear)
{
	for (const auto& built : built_)
		for (const auto& object : built.scene.objects)
		{
			const Footprint footprint = solidOf(object).footprint;
			for (const auto& place : built.way)
				ASSERT_GT(
					distance(footprint, place), description_.scene.pathClearance - 2 * kTolerance)
					<< nameOf(object);
			for (const auto& wall : built.plan.walls())
			{
				if (!wall.aboveDoor) continue;
				Footprint before = wall.footprint;
				before.size += 2 * kBeforeDoor * wall.inward.cwiseAbs();
				EXPECT_FALSE(overlap(footprint, before, 0)) << nameOf(object);
			}
		}
}

TEST_P(Scenes, ObjectsAreNumberedAndTheSeedDecides)
{
	for (const auto& built : built_)
		for (std::size_t i = 0; i < built.scene.objects.size(); ++i)
			EXPECT_EQ(built.scene.objects[i].id, i + 1);
	const auto again = buildScene(description_, catalog(), 1);
	ASSERT_EQ(again.scene.objects.size(), built_[0].scene.objects.size());
	bool differs = false;
	for (std::size_t i = 0; i < again.scene.objects.size(); ++i)
	{
		const auto& object = again.scene.objects[i];
		EXPECT_EQ(object.T_world_object, built_[0].scene.objects[i].T_world_object);
		EXPECT_EQ(object.model, built_[0].scene.objects[i].model);
		differs = differs || !(object.T_world_object == built_[1].scene.objects[i].T_world_object);
	}
	EXPECT_TRUE(differs);
}

INSTANTIATE_TEST_SUITE_P(
	All, Scenes, testing::ValuesIn(kScenes), [](const auto& scene) { return scene.param; });

class Apartment : public Scenes
{
};

TEST_P(Apartment, HasManyObjectsOfManyKinds)
{
	for (const auto& built : built_)
	{
		std::set<uint32_t> labels;
		for (const auto& object : built.scene.objects) labels.insert(object.label);
		EXPECT_GE(built.scene.objects.size(), 45u);
		EXPECT_LE(built.scene.objects.size(), 70u);
		EXPECT_GE(labels.size(), 20u);
	}
}
INSTANTIATE_TEST_SUITE_P(Scene, Apartment, testing::Values("apartment"));

class Corridor : public Scenes
{
};

TEST_P(Corridor, EveryOfficeIsACopyOfTheFirst)
{
	for (const auto& built : built_)
	{
		const auto& objects = built.scene.objects;
		ASSERT_EQ(objects.size() % 6, 0u);
		const std::size_t each = objects.size() / 6;
		for (std::size_t i = each; i < objects.size(); ++i)
		{
			const auto& original = objects[i % each];
			const auto moved = mrpt::poses::CPose3D(3.6 * double(i / each), 0, 0, 0, 0, 0) +
							   original.T_world_object;
			EXPECT_LT(moved.distanceTo(objects[i].T_world_object), 1e-9);
			EXPECT_EQ(objects[i].model, original.model);
			EXPECT_EQ(objects[i].label, original.label);
		}
	}
}
INSTANTIATE_TEST_SUITE_P(Scene, Corridor, testing::Values("corridor"));
