#include <gtest/gtest.h>
#include <semloop/slam/PathLine.h>

using namespace semloop;
using mrpt::math::TPoint3D;

namespace
{
Trajectory walk(const std::vector<TPoint3D>& positions)
{
	Trajectory result;
	for (const TPoint3D& p : positions)
	{
		result.emplace_back();
		result.back().pose = mrpt::poses::CPose3D(p.x, p.y, p.z, 1, 0, 0);
	}
	return result;
}
}  // namespace

TEST(PathLine, GoesFromPoseToPose)
{
	const auto line = pathLine(walk({{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}), kTrajectoryColor);
	ASSERT_EQ(line->size(), 2u);
	EXPECT_EQ(line->begin()[0].point1, TPoint3D(1, 2, 3));
	EXPECT_EQ(line->begin()[0].point2, TPoint3D(4, 5, 6));
	EXPECT_EQ(line->begin()[1].point2, TPoint3D(7, 8, 10));
	EXPECT_EQ(line->getColor_u8(), kTrajectoryColor);
	EXPECT_EQ(line->getVerticesPointSize(), 0);
}

TEST(PathLine, HasDotsWhenAskedFor)
{
	EXPECT_EQ(pathLine(walk({{0, 0, 0}, {1, 0, 0}}), kOdometryColor, 4)->getVerticesPointSize(), 4);
}

TEST(PathLine, OfLessThanTwoPosesIsEmpty)
{
	EXPECT_TRUE(pathLine({}, kOdometryColor)->empty());
	EXPECT_TRUE(pathLine(walk({{1, 2, 3}}), kOdometryColor, 3)->empty());
}
