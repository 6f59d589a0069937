#include <gtest/gtest.h>
#include <semloop/loop_closure/YawPose.h>

#include <cmath>
#include <random>

#include "GraphFixtures.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using mrpt::math::TPoint3D;
using mrpt::poses::CPose3D;

void expectNear(const CPose3D& a, const CPose3D& b)
{
	EXPECT_LT(a.distanceTo(b), 1e-9) << a << " and " << b;
	EXPECT_LT(rotationAngle(a - b), 1e-9) << a << " and " << b;
}

TEST(FitYawPose, IsExactForAMotionThatKeepsGravityWhateverTheWeights)
{
	const auto T = yawPose(1, -2, 0.5, 2.5);
	std::vector<WeightedPair> pairs;
	for (const auto& v : fourObjects().vertices)
		pairs.push_back({v.position, T.composePoint(v.position), 1.0 + double(pairs.size())});
	expectNear(fitYawPose(pairs)->toPose3D(), T);
}

TEST(FitYawPose, AQuarterTurnByHand)
{
	// x -> y, y -> -x, up by 1.
	const auto T = fitYawPose({{{1, 0, 0}, {0, 1, 1}}, {{-1, 0, 0}, {0, -1, 1}}});
	expectNear(T->toPose3D(), yawPose(0, 0, 1, M_PI / 2));
}

TEST(FitYawPose, AWeightPullsTheCentroid)
{
	// One object of two moved by 1 along the line between them; it weighs three times the other.
	const auto T = fitYawPose({{{0, 0, 0}, {0, 0, 0}, 1}, {{2, 0, 0}, {3, 0, 0}, 3}});
	expectNear(T->toPose3D(), yawPose(0.75, 0, 0, 0));
}

TEST(FitYawPose, IsAWeightedLeastSquaresFit)
{
	// No small change of any of the four parameters makes the sum of squares smaller.
	std::mt19937 random(1);
	std::normal_distribution<double> noise(0, 0.1);
	std::uniform_real_distribution<double> weight(0.1, 2);
	std::vector<WeightedPair> pairs;
	for (const auto& v : randomRoom(10, 1, 2).vertices)
		pairs.push_back(
			{v.position,
			 yawPose(1, 2, 3, 0.7).composePoint(v.position) +
				 TPoint3D(noise(random), noise(random), noise(random)),
			 weight(random)});
	const auto cost = [&](const CPose3D& T)
	{
		double sum = 0;
		for (const auto& pair : pairs)
			sum += pair.weight * (T.composePoint(pair.from) - pair.to).sqrNorm();
		return sum;
	};
	const auto T = fitYawPose(pairs)->toPose3D();
	for (const double step : {-1e-3, 1e-3})
	{
		EXPECT_GT(cost(yawPose(T.x() + step, T.y(), T.z(), T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y() + step, T.z(), T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y(), T.z() + step, T.yaw())), cost(T));
		EXPECT_GT(cost(yawPose(T.x(), T.y(), T.z(), T.yaw() + step)), cost(T));
	}
}

TEST(FitYawPose, IsEmptyWhenTheYawIsOpen)
{
	EXPECT_FALSE(fitYawPose({}));
	EXPECT_FALSE(fitYawPose({{{1, 2, 3}, {4, 5, 6}}}));
	EXPECT_FALSE(fitYawPose({{{1, 2, 3}, {4, 5, 6}}, {{1, 2, 9}, {4, 5, 12}}}));
	EXPECT_FALSE(fitYawPose({{{1, 2, 3}, {4, 5, 6}, 0}, {{2, 2, 3}, {5, 5, 6}, 0}}));
}
}  // namespace
