#include <gtest/gtest.h>

#include <random>

#include "../../libs/loop_closure/src/SurfaceClouds.h"

namespace
{
using namespace semloop;

TEST(NearestPoint, IsTheNearestOfAllThatAreWithin)
{
	std::mt19937 random(1);
	std::normal_distribution<double> normal(0, 0.3);
	// A flat cloud, as surfaces are.
	Eigen::Matrix3Xd points(3, 3000);
	for (Eigen::Index i = 0; i < points.cols(); ++i)
		points.col(i) = Eigen::Vector3d(normal(random), normal(random), 0.02 * normal(random));
	const NearestPoint nearest(points);
	constexpr double kWithin = 0.1;
	int outside = 0;
	for (int i = 0; i < 500; ++i)
	{
		const Eigen::Vector3d p(normal(random), normal(random), 0.3 * normal(random));
		Eigen::Index expected = 0;
		const double squared = (points.colwise() - p).colwise().squaredNorm().minCoeff(&expected);
		const auto found = nearest.find(p, kWithin);
		outside += !found;
		ASSERT_EQ(found.has_value(), squared <= kWithin * kWithin);
		if (found)
		{
			EXPECT_EQ(*found, expected);
		}
	}
	EXPECT_GT(outside, 50);
	EXPECT_LT(outside, 450);
}

TEST(NearestPoint, ADistanceItselfIsWithinIt)
{
	const NearestPoint nearest(Eigen::Matrix3Xd::Zero(3, 1));
	EXPECT_EQ(nearest.find({0.5, 0, 0}, 0.5), 0);
	EXPECT_FALSE(nearest.find({0.5001, 0, 0}, 0.5));
}
}  // namespace
