#include <gtest/gtest.h>
#include <semloop/slam/LocalMap.h>

using mrpt::poses::CPose3D;
using namespace semloop;
using Ids = std::set<ObjectId>;

namespace
{
LocalMap twoMetreMap()
{
	LocalMapOptions options;
	options.length = 2.0;
	options.metresPerRadian = 0.5;
	return LocalMap(options);
}
const CPose3D oneMetre(1, 0, 0, 0, 0, 0);
}  // namespace

TEST(LocalMap, IsEmptyAtFirst)
{
	EXPECT_TRUE(twoMetreMap().objects().empty());
}

TEST(LocalMap, KeepsAnObjectForItsLengthOfPath)
{
	LocalMap map = twoMetreMap();
	map.see(7);
	map.advance(oneMetre);
	map.advance(oneMetre);
	EXPECT_TRUE(map.contains(7));
	map.advance(CPose3D(0.01, 0, 0, 0, 0, 0));
	EXPECT_FALSE(map.contains(7));
}

TEST(LocalMap, CountsTurningAsPath)
{
	LocalMap map = twoMetreMap();
	map.advance(CPose3D(0, 0, 0, 1.0, 0, 0));
	EXPECT_NEAR(map.path(), 0.5, 1e-12);
}

TEST(LocalMap, IsOfTheFramesOfItsLengthOfPath)
{
	LocalMap map = twoMetreMap();
	EXPECT_EQ(map.firstFrame(), 0u);
	map.advance(CPose3D());  // frame 0
	for (int frame = 1; frame <= 2; ++frame) map.advance(oneMetre);
	EXPECT_EQ(map.firstFrame(), 0u) << "exactly two metres back";
	map.advance(oneMetre);
	EXPECT_EQ(map.firstFrame(), 1u);
}

TEST(LocalMap, ForgetsNothingForAWhileWhenItIsAskedTo)
{
	LocalMap map = twoMetreMap();  // and two metres of growth
	map.see(7);
	for (int i = 0; i < 2; ++i) map.advance(oneMetre);
	map.keepGrowing(true);
	for (int i = 0; i < 2; ++i)
	{
		map.advance(oneMetre);
		map.keepGrowing(true);
		EXPECT_TRUE(map.contains(7));
		EXPECT_EQ(map.firstFrame(), 0u);
	}
	map.advance(CPose3D(0.01, 0, 0, 0, 0, 0));
	EXPECT_FALSE(map.contains(7)) << "more than four metres";

	map.see(8);
	map.advance(CPose3D(3, 0, 0, 0, 0, 0));
	EXPECT_TRUE(map.contains(8));
	map.keepGrowing(false);
	EXPECT_FALSE(map.contains(8));
}

TEST(LocalMap, AnObjectThatStaysInViewStays)
{
	LocalMap map = twoMetreMap();
	map.see(1);
	for (int i = 0; i < 5; ++i)
	{
		map.advance(oneMetre);
		map.see(1);
	}
	EXPECT_EQ(map.objects(), Ids{1});
}

TEST(LocalMap, AMergedObjectWasSeenWhenOneOfTheTwoWas)
{
	LocalMap map = twoMetreMap();
	map.see(1);
	map.advance(oneMetre);
	map.see(2);
	map.merge(1, 2);
	EXPECT_EQ(map.objects(), Ids{1});
	map.advance(oneMetre);
	map.advance(CPose3D(0.5, 0, 0, 0, 0, 0));
	EXPECT_TRUE(map.contains(1));  // 1.5 m after 2 was seen, 2.5 m after 1 itself
}

TEST(LocalMap, ARemovedObjectIsGone)
{
	LocalMap map = twoMetreMap();
	map.see(1);
	map.see(2);
	map.remove(1);
	EXPECT_EQ(map.objects(), Ids{2});
}

TEST(LocalMap, ALoopIsDueAtFirstAndThenAfterAMetre)
{
	LocalMap map = twoMetreMap();
	EXPECT_TRUE(map.isLoopDue());
	map.advance(oneMetre);
	map.loopClosed();
	EXPECT_FALSE(map.isLoopDue());
	map.advance(CPose3D(0.9, 0, 0, 0, 0, 0));
	EXPECT_FALSE(map.isLoopDue());
	map.advance(CPose3D(0.2, 0, 0, 0, 0, 0));
	EXPECT_TRUE(map.isLoopDue());
}
