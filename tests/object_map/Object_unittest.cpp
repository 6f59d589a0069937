#include <gtest/gtest.h>
#include <semloop/object_map/Object.h>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

TEST(Object, WithoutASurfaceItsCentreIsItsOriginAndItHasNoExtent)
{
	Object object;
	object.T_world_object = CPose3D(1, 2, 3, 0.5, 0, 0);
	for (const auto& volume : {std::shared_ptr<TsdfVolume>(), std::make_shared<TsdfVolume>()})
	{
		object.volume = volume;
		EXPECT_EQ(object.centre(), TPoint3D(1, 2, 3));
		EXPECT_EQ(object.extent(), TVector3D(0, 0, 0));
	}
}

TEST(Object, ItsCentreAndExtentAreThoseOfTheSurfaceSeenFromAllSides)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	// Tolerance: two voxels, and the undersides that no camera sees.
	const Object& box = map.object(1);
	EXPECT_NEAR(box.centre().x, 0.0, 0.01);
	EXPECT_NEAR(box.centre().y, 0.45, 0.01);
	EXPECT_NEAR(box.centre().z, 0.775, 0.015);
	EXPECT_NEAR(box.extent().x, 0.3, 0.02);
	EXPECT_NEAR(box.extent().y, 0.2, 0.02);
	EXPECT_NEAR(box.extent().z, 0.15, 0.03);
	const Object& ball = map.object(0);
	EXPECT_NEAR(ball.extent().x, 0.3, 0.02);
	EXPECT_NEAR(ball.extent().y, 0.3, 0.02);
}

TEST(Object, ItsExtentIsAlongItsOwnAxesAndItsCentreInTheWorld)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const TVector3D extent = map.object(1).extent();
	const CPose3D turn(5, 0, 0, M_PI / 2, 0, 0);
	const TPoint3D expected = turn.composePoint(map.object(1).centre());
	map.moveObjects({{1, turn + map.object(1).T_world_object}});
	EXPECT_EQ(map.object(1).extent(), extent);
	EXPECT_NEAR(map.object(1).centre().distanceTo(expected), 0, 1e-9);
}
