#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/simulation/CameraPath.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "TemporaryFolder.h"

using namespace semloop;
using Eigen::Vector2d;
using testing::AllOf;
using testing::HasSubstr;

namespace
{
const std::vector<Vector2d> kCorners{{0, 0}, {9, 0}, {9, 1.5}, {4, 3}, {0, 2}};
const auto kStart = mrpt::Clock::fromDouble(1000.0);
constexpr double kRate = 30.0;

double nearest(const std::vector<Vector2d>& way, const Vector2d& point)
{
	double least = 1e9;
	for (const auto& place : way) least = std::min(least, (place - point).norm());
	return least;
}

/** Carried without swaying and shaking, looking ahead. */
PathOptions steady()
{
	PathOptions options;
	options.sway = options.jitterTranslation = options.jitterRotation = 0;
	return options;
}

Trajectory carried(const PathOptions& options, uint64_t seed = 1)
{
	return carriedCamera(splineThrough(kCorners, true), options, kRate, kStart, seed);
}

/** Where the optical axis points, in the world. */
Vector2d lookOf(const StampedPose& camera)
{
	const auto axis = camera.pose.rotateVector({0, 0, 1});
	return Vector2d(axis.x, axis.y).normalized();
}

Vector2d placeOf(const StampedPose& camera)
{
	return {camera.pose.x(), camera.pose.y()};
}

double angleBetween(const mrpt::poses::CPose3D& a, const mrpt::poses::CPose3D& b)
{
	const auto R = (b - a).getRotationMatrix();
	return std::acos(std::clamp((R(0, 0) + R(1, 1) + R(2, 2) - 1) / 2, -1.0, 1.0));
}
/** What shaking does to x, y [m] and to yaw, pitch, roll [rad]: their RMS over a walk of 55 s, by five
 *  seeds. */
std::array<double, 5> shakingOf(const PathOptions& options)
{
	constexpr int kSeeds = 5;
	std::array<double, 5> squares{};
	std::size_t count = 0;
	for (uint64_t seed = 1; seed <= kSeeds; ++seed)
	{
		const auto still = carried(steady(), seed), shaken = carried(options, seed);
		for (std::size_t i = 0; i < still.size(); ++i, ++count)
		{
			const auto a = still[i].pose + (-sensorFromCamera());
			const auto b = shaken[i].pose + (-sensorFromCamera());
			const std::array differences{
				b.x() - a.x(), b.y() - a.y(), std::remainder(b.yaw() - a.yaw(), 2 * M_PI),
				b.pitch() - a.pitch(), b.roll() - a.roll()};
			for (std::size_t k = 0; k < squares.size(); ++k)
				squares[k] += differences[k] * differences[k];
		}
	}
	for (auto& square : squares) square = std::sqrt(square / double(count));
	return squares;
}
}  // namespace

TEST(CameraPath, TheSplineGoesThroughTheWaypointsInEqualSteps)
{
	for (const bool closed : {false, true})
	{
		const auto way = splineThrough(kCorners, closed);
		for (const auto& corner : kCorners) EXPECT_LT(nearest(way, corner), 0.0101);
		EXPECT_EQ(way.front(), kCorners.front());
		EXPECT_LT((way.back() - (closed ? kCorners.front() : kCorners.back())).norm(), 1e-9);
		for (std::size_t i = 1; i < way.size(); ++i)
		{
			const double step = (way[i] - way[i - 1]).norm();
			ASSERT_LT(step, 0.0201) << i;
			ASSERT_GT(step, 0.0190) << i;
		}
	}
}

TEST(CameraPath, TwoWaypointsAreJoinedByALine)
{
	const auto way = splineThrough({{0, 1}, {6, 1}}, false);
	EXPECT_EQ(way.size(), 301u);
	for (const auto& place : way) EXPECT_NEAR(place.y(), 1, 1e-12);
}

TEST(CameraPath, AWayOnWhichNobodyCanWalkIsAnError)
{
	for (const double length : {0.0, 0.3})
		EXPECT_THAT(
			messageOf<InputError>(
				[&] {
					splineThrough({{0, 0}, {length, 0}}, false);
				}),
			HasSubstr("too short"));
}

TEST(CameraPath, AWayThroughAWallIsNamedWithThePlace)
{
	const FloorPlan plan({{"a", {0, 0}, {4, 3}}, {"b", {4.1, 0}, {4, 3}}}, {{{4.05, 1}, 0.9}}, 2.5);
	EXPECT_NO_THROW(requireFreeWay(splineThrough({{1, 1}, {7, 1}}, false), plan, 0.2));
	// Comes within 0.2 m of the wall at x = 4 when it is at 3.8.
	EXPECT_THAT(
		messageOf<InputError>(
			[&] {
				requireFreeWay(splineThrough({{1, 2}, {7, 2}}, false), plan, 0.2);
			}),
		AllOf(HasSubstr("wall"), HasSubstr("(3.82, 2.00)")));
}

TEST(CameraPath, HeIsAsFastAsAsked)
{
	for (const double speed : {0.2, 1.0})
	{
		PathOptions options = steady();
		options.speed = speed;
		const auto trajectory = carried(options);
		double length = 0;
		for (std::size_t i = 1; i < trajectory.size(); ++i)
		{
			const double step = (placeOf(trajectory[i]) - placeOf(trajectory[i - 1])).norm();
			ASSERT_LT(step * kRate, 1.1 * speed);
			length += step;
		}
		EXPECT_NEAR(length / double(trajectory.size() - 1) * kRate, speed, 0.02 * speed);
	}
}

TEST(CameraPath, TimesAreAPeriodApart)
{
	const auto trajectory = carried(steady());
	EXPECT_EQ(trajectory.front().time, kStart);
	EXPECT_NEAR(mrpt::Clock::toDouble(trajectory[300].time) - 1000.0, 10.0, 1e-6);
}

TEST(CameraPath, HeLooksWhereHeGoesAndDownByThePitch)
{
	PathOptions options = steady();
	options.pitch = mrpt::DEG2RAD(-20.0);
	const auto trajectory =
		carriedCamera(splineThrough({{0, 0}, {0, 5}}, false), options, kRate, kStart, 1);
	for (const auto& camera : trajectory)
	{
		const auto axis = camera.pose.rotateVector({0, 0, 1});
		ASSERT_NEAR(axis.y, std::cos(options.pitch), 1e-9);
		ASSERT_NEAR(axis.z, std::sin(options.pitch), 1e-9);
		ASSERT_NEAR(camera.pose.rotateVector({1, 0, 0}).x, 1, 1e-9) << "the image is upright";
	}
}

TEST(CameraPath, HeTurnsRoundAndComesBackLookingTheOtherWay)
{
	PathOptions options = steady();
	options.returns = true;
	const auto way = splineThrough({{0, 0}, {5, 0}, {8, 2}}, false);
	const auto trajectory = carriedCamera(way, options, kRate, kStart, 1);
	EXPECT_LT((placeOf(trajectory.back()) - way.front()).norm(), 0.02);
	// At x = 2 on the way out and on the way back.
	std::vector<Vector2d> looks;
	for (std::size_t i = 1; i < trajectory.size(); ++i)
		if ((placeOf(trajectory[i]).x() < 2) != (placeOf(trajectory[i - 1]).x() < 2))
			looks.push_back(lookOf(trajectory[i]));
	ASSERT_EQ(looks.size(), 2u);
	EXPECT_LT(looks[0].dot(looks[1]), -0.99);
}

TEST(CameraPath, HeightsStayBetweenTheLimitsAndUseThem)
{
	PathOptions options;
	options.minimumHeight = 1.1;
	options.maximumHeight = 1.5;
	double low = 9, high = 0;
	for (const auto& camera : carried(options))
	{
		low = std::min(low, camera.pose.z());
		high = std::max(high, camera.pose.z());
	}
	EXPECT_GE(low, 1.1 - 1e-9);
	EXPECT_LE(high, 1.5 + 1e-9);
	EXPECT_GT(high - low, 0.2);
}

TEST(CameraPath, HeSwaysToBothSides)
{
	PathOptions options = steady();
	options.sway = mrpt::DEG2RAD(30.0);
	double left = 0, right = 0;
	for (const auto& camera :
		 carriedCamera(splineThrough({{0, 0}, {9, 0}}, false), options, kRate, kStart, 1))
	{
		left = std::max(left, std::asin(lookOf(camera).y()));
		right = std::min(right, std::asin(lookOf(camera).y()));
	}
	EXPECT_NEAR(mrpt::RAD2DEG(left), 30, 0.2);
	EXPECT_NEAR(mrpt::RAD2DEG(right), -30, 0.2);
}

TEST(CameraPath, TheHandShakesThePlaceByItsSigma)
{
	PathOptions options = steady();
	options.jitterTranslation = 0.01;
	const auto [x, y, yaw, pitch, roll] = shakingOf(options);
	EXPECT_NEAR(x, 0.01, 0.001);
	EXPECT_NEAR(y, 0.01, 0.001);
	for (const double turned : {yaw, pitch, roll}) EXPECT_LT(turned, 1e-9);
}

TEST(CameraPath, TheHandShakesTheDirectionByItsSigma)
{
	PathOptions options = steady();
	options.jitterRotation = 0.02;
	const auto [x, y, yaw, pitch, roll] = shakingOf(options);
	for (const double turned : {yaw, pitch, roll}) EXPECT_NEAR(turned, 0.02, 0.002);
	for (const double moved : {x, y}) EXPECT_LT(moved, 1e-9);
}

TEST(CameraPath, NoFrameJumps)
{
	PathOptions options;
	options.returns = true;
	const auto trajectory = carried(options);
	for (std::size_t i = 1; i < trajectory.size(); ++i)
	{
		// 13 mm by walking at 0.4 m/s, the rest by shaking; half a turn in 5 s is 1.9 degrees a frame.
		const auto &a = trajectory[i - 1].pose, &b = trajectory[i].pose;
		ASSERT_LT(b.distanceTo(a), 0.025) << i;
		ASSERT_LT(mrpt::RAD2DEG(angleBetween(a, b)), 4.0) << i;
	}
}

TEST(CameraPath, TheSeedDecides)
{
	const auto first = carried({}, 7), again = carried({}, 7), other = carried({}, 8);
	ASSERT_EQ(first.size(), again.size());
	double difference = 0;
	for (std::size_t i = 0; i < first.size(); ++i)
	{
		ASSERT_EQ(first[i].pose, again[i].pose);
		difference = std::max(difference, angleBetween(first[i].pose, other[i].pose));
	}
	EXPECT_GT(difference, 0.1);
}
