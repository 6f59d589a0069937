#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/SurfaceError.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace semloop
{
namespace
{
using Eigen::Vector3d;

/** Two triangles in the plane z = 0 between (0, 0) and (1, 1). */
Surface square()
{
	return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

double distanceTo(const Surface& surface, const Vector3d& point)
{
	return distancesToSurface({point}, surface).at(0);
}

TEST(SurfaceError, IsTheDistanceToTheFaceTheEdgeOrTheCorner)
{
	EXPECT_DOUBLE_EQ(distanceTo(square(), {0.3, 0.6, 0}), 0);
	EXPECT_DOUBLE_EQ(distanceTo(square(), {0.3, 0.6, -0.2}), 0.2);
	EXPECT_DOUBLE_EQ(distanceTo(square(), {1.3, 0.5, 0.4}), 0.5);
	EXPECT_DOUBLE_EQ(distanceTo(square(), {-1, -2, 2}), 3);
}

TEST(SurfaceError, ATriangleWithoutAreaIsASegment)
{
	const Surface segment{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
	EXPECT_DOUBLE_EQ(distanceTo(segment, {1.5, 3, 4}), 5);
}

TEST(SurfaceError, IsThatOfTheNearestOfManyTriangles)
{
	// 500 small triangles: the tree must agree with one triangle at a time.
	std::mt19937 random(5);
	const auto number = [&] { return double(random() % 2001) / 1000 - 1; };
	Surface all;
	for (uint32_t i = 0; i < 500; i++)
	{
		const Vector3d corner(number(), number(), number());
		for (int k = 0; k < 3; k++)
			all.vertices.push_back(corner + 0.1 * Vector3d(number(), number(), number()));
		all.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
	}
	for (int i = 0; i < 50; i++)
	{
		const Vector3d point(1.5 * number(), 1.5 * number(), 1.5 * number());
		double nearest = 1e9;
		for (const auto& triangle : all.triangles)
			nearest = std::min(nearest, distanceTo({all.vertices, {triangle}}, point));
		EXPECT_EQ(distanceTo(all, point), nearest);
	}
}

TEST(SurfaceError, CarriesTheEstimateIntoTheTrueWorld)
{
	const mrpt::poses::CPose3D T_truth_estimate(0, 0, 0.25, 0, 0, 0);
	for (const double error : surfaceErrors(square(), square(), T_truth_estimate))
		EXPECT_DOUBLE_EQ(error, 0.25);
}

TEST(SurfaceError, HasTheTextbookStatistics)
{
	std::vector<double> distances;
	for (int i = 100; i >= 1; i--) distances.push_back(i);
	const auto summary = summarizeSurfaceErrors(distances);
	EXPECT_EQ(summary.percentile95, 95);
	EXPECT_EQ(summary.distance.median, 50.5);
	EXPECT_EQ(summary.distance.count, 100u);
	EXPECT_EQ(summarizeSurfaceErrors({4}).percentile95, 4);
	EXPECT_EQ(summarizeSurfaceErrors({}).percentile95, 0);
}

TEST(SurfaceError, NeedsATriangleButNoPoint)
{
	EXPECT_TRUE(distancesToSurface({}, square()).empty());
	EXPECT_THROW(distanceTo({{{0, 0, 0}}, {}}, {1, 0, 0}), InputError);
}
}  // namespace
}  // namespace semloop
