#include <gtest/gtest.h>
#include <semloop/pose_graph/CeresPoseGraph.h>
#include <semloop/slam/KeyFrames.h>

using namespace semloop;
using mrpt::poses::CPose3D;

namespace
{
constexpr double kDegree = M_PI / 180;

/** Frames as a camera passes these poses, and those that are kept. */
std::vector<std::size_t> kept(KeyFrames frames, const std::vector<CPose3D>& cameras)
{
	CeresPoseGraph graph;
	for (std::size_t i = 0; i < cameras.size(); ++i)
	{
		graph.setNode(NodeId::camera(i), cameras[i]);
		frames.offer({i, nullptr, nullptr}, graph);
	}
	std::vector<std::size_t> numbers;
	for (const auto& key : frames.all()) numbers.push_back(key.frame);
	return numbers;
}

/** Looks along x at yaw 0. */
CPose3D camera(double x, double yaw)
{
	return CPose3D(x, 0, 1, yaw, 0, 0) + CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
}

std::vector<CPose3D> straight(int count)
{
	std::vector<CPose3D> poses;
	for (int i = 0; i < count; ++i) poses.push_back(camera(0.1 * i, 0));
	return poses;
}
}  // namespace

TEST(KeyFrames, AreADistanceApart)
{
	const std::vector<std::size_t> everyThird = {0, 3, 6, 9};
	EXPECT_EQ(kept(KeyFrames(0.25, 20 * kDegree, 100), straight(10)), everyThird);
}

TEST(KeyFrames, OrAnAngleOfTheView)
{
	std::vector<CPose3D> turning;
	for (int i = 0; i < 8; ++i) turning.push_back(camera(0, 10 * kDegree * i));
	const std::vector<std::size_t> everyThird = {0, 3, 6};
	EXPECT_EQ(kept(KeyFrames(0.25, 25 * kDegree, 100), turning), everyThird);
}

TEST(KeyFrames, ARollOfTheSameViewIsNoOther)
{
	const CPose3D roll(0, 0, 0, 90 * kDegree, 0, 0);  // about the optical axis
	EXPECT_EQ(
		kept(KeyFrames(0.25, 20 * kDegree, 100), {camera(0, 0), camera(0, 0) + roll}).size(), 1u);
}

TEST(KeyFrames, ASecondTimeThroughTheSamePlaceAddsNone)
{
	std::vector<CPose3D> poses = straight(10);
	const auto once = kept(KeyFrames(0.25, 20 * kDegree, 100), poses);
	for (int round = 0; round < 3; ++round)
		for (const auto& pose : straight(10)) poses.push_back(pose);
	EXPECT_EQ(kept(KeyFrames(0.25, 20 * kDegree, 100), poses), once);
	// The way back looks the other way.
	for (int i = 0; i < 10; ++i) poses.push_back(camera(0.1 * i, M_PI));
	EXPECT_EQ(kept(KeyFrames(0.25, 20 * kDegree, 100), poses).size(), 2 * once.size());
}

TEST(KeyFrames, WithoutRoomForMoreTheyAreThinnedAndFurtherApart)
{
	// 0 3 6 9 12 -> 0 6 12, from then on 0.48 m apart: 17 22 -> 0 12 22, then 0.96 m: 32.
	const std::vector<std::size_t> expected = {0, 12, 22, 32};
	EXPECT_EQ(kept(KeyFrames(0.24, 20 * kDegree, 4), straight(42)), expected);
}
