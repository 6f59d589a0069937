#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/simulation/FloorPlan.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "TemporaryFolder.h"

using namespace semloop;
using Eigen::Vector2d;
using testing::AllOf;
using testing::HasSubstr;

namespace
{
constexpr double kQuarter = M_PI / 2;

/** Two rooms of 4 x 3 m side by side, a door in the wall between them. */
FloorPlan twoRooms(const std::vector<Door>& doors = {{{4.05, 1.5}, 0.9}})
{
	return FloorPlan({{"left", {0, 0}, {4, 3}}, {"right", {4.1, 0}, {4, 3}}}, doors, 2.5);
}

std::string errorOf(const std::vector<Room>& rooms, const std::vector<Door>& doors)
{
	return messageOf<InputError>([&] { FloorPlan(rooms, doors, 2.5); });
}

double doorArea(const FloorPlan& plan)
{
	double area = 0;
	for (const auto& wall : plan.walls())
		if (wall.aboveDoor) area += wall.footprint.size.prod();
	return area;
}
}  // namespace

TEST(Footprint, CornersTurnWithIt)
{
	const auto corners = Footprint{{1, 2}, {4, 2}, kQuarter}.corners();
	ASSERT_EQ(corners.size(), 4u);
	EXPECT_LT((corners[0] - Vector2d(2, 0)).norm(), 1e-12);
	EXPECT_LT((corners[1] - Vector2d(2, 4)).norm(), 1e-12);
	EXPECT_LT((corners[2] - Vector2d(0, 4)).norm(), 1e-12);
	EXPECT_LT((corners[3] - Vector2d(0, 0)).norm(), 1e-12);
}

TEST(Footprint, OverlapKeepsTheClearance)
{
	const Footprint a{{0, 0}, {1, 1}, 0}, b{{1.05, 0}, {1, 1}, 0};
	EXPECT_FALSE(overlap(a, b, 0.04));
	EXPECT_TRUE(overlap(a, b, 0.06));
	EXPECT_TRUE(overlap(a, a, 0));
}

TEST(Footprint, OverlapKnowsTurnedOnes)
{
	// Half a diagonal, 0.707, and half a side, 0.5: 1.207 along x.
	const Footprint square{{0, 0}, {1, 1}, 0};
	EXPECT_TRUE(overlap(square, {{1.20, 0}, {1, 1}, M_PI / 4}, 0));
	EXPECT_FALSE(overlap(square, {{1.21, 0}, {1, 1}, M_PI / 4}, 0));
	// The boxes around them overlap, they do not: 1.414 between the centres on the diagonal.
	EXPECT_FALSE(overlap(square, {{1, 1}, {1, 1}, M_PI / 4}, 0.2));
	EXPECT_TRUE(overlap(square, {{1, 1}, {1, 1}, M_PI / 4}, 0.22));
}

TEST(Footprint, DistanceIsToTheNearestPointAndZeroInside)
{
	const Footprint wide{{0, 0}, {2, 1}, 0}, high{{0, 0}, {2, 1}, kQuarter};
	EXPECT_EQ(distance(wide, {0.9, 0.4}), 0);
	EXPECT_DOUBLE_EQ(distance(wide, {3, 0}), 2);
	EXPECT_DOUBLE_EQ(distance(wide, {4, -4.5}), 5);  // 3 beside, 4 in front
	EXPECT_NEAR(distance(high, {0, 3}), 2, 1e-12);
	EXPECT_NEAR(distance(high, {3, 0}), 2.5, 1e-12);
}

TEST(FloorPlan, WallsStandOutsideAndLookInside)
{
	const FloorPlan plan({{"room", {1, 2}, {4, 3}}}, {}, 2.5);
	ASSERT_EQ(plan.walls().size(), 4u);
	const Footprint room = plan.rooms()[0].footprint();
	for (const auto& wall : plan.walls())
	{
		EXPECT_FALSE(overlap(wall.footprint, room, -1e-9));
		EXPECT_NEAR(distance(room, wall.footprint.center), FloorPlan::kWallThickness / 2, 1e-12);
		EXPECT_EQ(distance(room, wall.footprint.center + 0.06 * wall.inward), 0);
		EXPECT_FALSE(wall.aboveDoor);
	}
}

TEST(FloorPlan, ADoorOpensTheWallsOfBothRooms)
{
	const FloorPlan plan = twoRooms();
	// Each of the two walls is cut in three.
	EXPECT_EQ(plan.walls().size(), 12u);
	EXPECT_NEAR(doorArea(plan), 2 * 0.9 * 0.1, 1e-9);
}

TEST(FloorPlan, APersonIsFreeInRoomsAndDoorsOnly)
{
	const FloorPlan plan = twoRooms();
	EXPECT_TRUE(plan.isFree({2, 0.3}, 0.25));
	EXPECT_FALSE(plan.isFree({2, 0.3}, 0.35)) << "the wall is 0.3 m away";
	EXPECT_TRUE(plan.isFree({4.05, 1.5}, 0.4)) << "in the door";
	EXPECT_FALSE(plan.isFree({4.05, 1.5}, 0.5)) << "the door is 0.9 m wide";
	EXPECT_FALSE(plan.isFree({4.05, 0.5}, 0.1)) << "in the wall";
	EXPECT_FALSE(plan.isFree({2, -1}, 0.1)) << "outside";
}

TEST(FloorPlan, ADoorInNoWallIsNamedWithItsPlace)
{
	const std::vector<Room> room{{"room", {0, 0}, {4, 3}}};
	EXPECT_THAT(
		errorOf(room, {{{2, 1.5}, 0.9}}), AllOf(HasSubstr("(2, 1.5)"), HasSubstr("no wall")));
	EXPECT_THAT(errorOf(room, {{{4.05, 2.8}, 0.9}}), HasSubstr("too near to a corner"));
	EXPECT_EQ(errorOf(room, {{{4.05, 2.5}, 0.9}}), "");
}

TEST(FloorPlan, RoomsThatOverlapOrShareAWallsPlaceAreNamed)
{
	for (const double x : {3.0, 4.0, 4.05})
		EXPECT_THAT(
			errorOf({{"den", {0, 0}, {4, 3}}, {"hall", {x, 1}, {4, 3}}}, {}),
			AllOf(HasSubstr("'den'"), HasSubstr("'hall'"), HasSubstr("overlap")))
			<< x;
	EXPECT_EQ(errorOf({{"den", {0, 0}, {4, 3}}, {"hall", {4.1, 1}, {4, 3}}}, {}), "");
}

TEST(FloorPlan, TheMeshReachesFromFloorToCeilingAndDependsOnTheSeedAlone)
{
	const Mesh mesh = twoRooms().mesh(3), again = twoRooms().mesh(3), other = twoRooms().mesh(4);
	const Bounds bounds = boundsOf(mesh);
	EXPECT_EQ(bounds.minimum.z(), 0);
	EXPECT_EQ(bounds.maximum.z(), 2.5F);
	ASSERT_EQ(mesh.textures.size(), again.textures.size());
	double difference = 0;
	for (std::size_t i = 0; i < mesh.textures.size(); ++i)
	{
		EXPECT_EQ(cv::norm(mesh.textures[i], again.textures[i], cv::NORM_INF), 0);
		difference += cv::norm(mesh.textures[i], other.textures[i], cv::NORM_INF);
	}
	EXPECT_GT(difference, 0);
}
