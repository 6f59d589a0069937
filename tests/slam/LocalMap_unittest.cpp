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
	EXPECT_TRUE(twoMetreMap().query().empty());
}

TEST(LocalMap, KeepsAnObjectForItsLengthOfPath)
{
	LocalMap map = twoMetreMap();
	map.see(7, true);
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

TEST(LocalMap, AnObjectThatComesBackIsRevisitedAndNoPartOfTheQuery)
{
	LocalMap map = twoMetreMap();
	map.see(1, true);
	for (int i = 0; i < 3; ++i) map.advance(oneMetre);
	map.see(1, false);
	map.see(2, true);
	EXPECT_EQ(map.objects(), (Ids{1, 2}));
	EXPECT_TRUE(map.isRevisited(1));
	EXPECT_EQ(map.query(), Ids{2});
}

TEST(LocalMap, AnObjectThatStaysInViewIsNotRevisited)
{
	LocalMap map = twoMetreMap();
	map.see(1, true);
	for (int i = 0; i < 5; ++i)
	{
		map.advance(oneMetre);
		map.see(1, false);
	}
	EXPECT_FALSE(map.isRevisited(1));
}

TEST(LocalMap, AfterALoopClosureWhatIsInViewBelongsToThisTime)
{
	LocalMap map = twoMetreMap();
	map.see(1, true);
	for (int i = 0; i < 3; ++i) map.advance(oneMetre);
	map.see(2, true);
	map.merge(1, 2);
	map.loopClosed();
	EXPECT_EQ(map.query(), Ids{1});
	EXPECT_FALSE(map.contains(2));
}

TEST(LocalMap, ARemovedObjectIsGone)
{
	LocalMap map = twoMetreMap();
	map.see(1, true);
	map.remove(1);
	EXPECT_TRUE(map.objects().empty());
}
