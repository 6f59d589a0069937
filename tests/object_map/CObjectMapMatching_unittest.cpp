#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <semloop/config/Error.h>

#include <cmath>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
/** A map of a ball of 0.3 m at (0, 0, 0.85). */
CObjectMap mapOfBall()
{
	Scene scene;
	scene.spheres.push_back({{0, 0, 0.85}, 0.15, {40, 40, 220}, 1, 0});
	return mapOf(scene, {kCup});
}

double distanceFromBall(float x, float y, float z, double shift = 0)
{
	return std::abs(std::hypot(x - shift, y, z - 0.85) - 0.15);
}

mrpt::maps::TMatchingParams within(float distance)
{
	mrpt::maps::TMatchingParams params;
	params.maxDistForCorrespondence = distance;
	params.maxAngularDistForCorrespondence = 0;
	return params;
}
}  // namespace

TEST(CObjectMapMatching, ItsPointsLieOnTheSurfacesAndFollowTheObjects)
{
	CObjectMap map = mapOfBall();
	const auto* points = map.getAsSimplePointsMap();
	ASSERT_NE(points, nullptr);
	ASSERT_GT(points->size(), 200u);
	float x = 0, y = 0, z = 0;
	for (std::size_t i = 0; i < points->size(); ++i)
	{
		points->getPoint(i, x, y, z);
		EXPECT_LT(distanceFromBall(x, y, z), 0.01);
	}
	EXPECT_EQ(map.getAsSimplePointsMap(), points);  // not made again

	auto moved = map.object(0).T_world_object;
	moved.x(moved.x() + 1);
	map.moveObjects({{0, moved}});
	points = map.getAsSimplePointsMap();
	points->getPoint(0, x, y, z);
	EXPECT_LT(distanceFromBall(x, y, z, 1), 0.01);
}

TEST(CObjectMapMatching, OfItselfEveryPointHasAPartner)
{
	const CObjectMap map = mapOfBall();
	mrpt::tfest::TMatchingPairList pairs;
	mrpt::maps::TMatchingExtraResults extra;
	map.determineMatching3D(&map, CPose3D(0.004, 0, 0, 0, 0, 0), pairs, within(0.02f), extra);
	EXPECT_EQ(pairs.size(), map.getAsSimplePointsMap()->size());
	EXPECT_NEAR(extra.correspondencesRatio, 1, 1e-6);

	mrpt::maps::TMatchingRatioParams ratio;
	ratio.maxDistForCorr = 0.02f;
	EXPECT_NEAR(map.compute3DMatchingRatio(&map, CPose3D(), ratio), 1, 1e-6);
	EXPECT_EQ(map.compute3DMatchingRatio(&map, CPose3D(5, 0, 0, 0, 0, 0), ratio), 0);
}

TEST(CObjectMapMatching, MatchesPointMapsAndRefusesMapsWithoutPoints)
{
	const CObjectMap map = mapOfBall();
	mrpt::maps::CSimplePointsMap other;
	float x = 0, y = 0, z = 0;
	map.getAsSimplePointsMap()->getPoint(0, x, y, z);
	other.insertPoint(x, y, z + 0.001f);
	other.insertPoint(5, 0, 0.85f);
	mrpt::tfest::TMatchingPairList pairs;
	mrpt::maps::TMatchingExtraResults extra;
	map.determineMatching3D(&other, CPose3D(), pairs, within(0.03f), extra);
	ASSERT_EQ(pairs.size(), 1u);
	EXPECT_EQ(pairs[0].localIdx, 0u);
	EXPECT_NEAR(extra.correspondencesRatio, 0.5, 1e-6);

	const mrpt::maps::COccupancyGridMap2D grid;
	EXPECT_THROW(
		map.determineMatching3D(&grid, CPose3D(), pairs, within(0.03f), extra), InputError);
}

TEST(CObjectMapMatching, TellsHowFarTheNearestSurfaceIsFromAbove)
{
	const CObjectMap map = mapOfBall();
	EXPECT_LT(map.squareDistanceToClosestCorrespondence(0, 0), 0.02 * 0.02);
	EXPECT_NEAR(map.squareDistanceToClosestCorrespondence(3, 0), 2.85 * 2.85, 0.05);
}
