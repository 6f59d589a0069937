#include "../../libs/sensors/src/ObservationQueue.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cstddef>

using namespace semloop;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationOdometry;

namespace
{
CObservation::Ptr frame()
{
	return CObservation3DRangeScan::Create();
}
CObservation::Ptr other()
{
	return CObservationOdometry::Create();
}
}  // namespace

TEST(ObservationQueue, IsEmptyAtFirstAndHasRoom)
{
	ObservationQueue queue(1);
	EXPECT_TRUE(queue.isEmpty());
	EXPECT_EQ(queue.frames(), 0u);
	EXPECT_FALSE(queue.isFullFor(*frame()));
	EXPECT_FALSE(queue.isFullFor(*other()));
	EXPECT_FALSE(queue.pop());
	queue.dropOldestLike(*frame());
	EXPECT_TRUE(queue.isEmpty());
}

TEST(ObservationQueue, GivesTheOldestFirstWhateverItIsAndCountsFrames)
{
	ObservationQueue queue(5);
	const auto a = other(), b = frame(), c = other(), d = frame();
	for (const auto& observation : {a, b, c, d}) queue.push(observation);
	EXPECT_EQ(queue.frames(), 2u);
	EXPECT_EQ(queue.pop(), a);
	EXPECT_EQ(queue.frames(), 2u);
	EXPECT_EQ(queue.pop(), b);
	EXPECT_EQ(queue.frames(), 1u);
	EXPECT_EQ(queue.pop(), c);
	EXPECT_EQ(queue.pop(), d);
	EXPECT_EQ(queue.frames(), 0u);
	EXPECT_TRUE(queue.isEmpty());
}

TEST(ObservationQueue, FramesAndOthersHaveRoomApartFromEachOther)
{
	ObservationQueue queue(2);
	queue.push(frame());
	EXPECT_FALSE(queue.isFullFor(*frame()));
	queue.push(frame());
	EXPECT_TRUE(queue.isFullFor(*frame()));
	for (int i = 0; i < 200; ++i)
	{
		EXPECT_FALSE(queue.isFullFor(*other()));
		queue.push(other());
	}
	EXPECT_TRUE(queue.isFullFor(*other()));
	queue.pop();
	EXPECT_FALSE(queue.isFullFor(*frame()));
	EXPECT_TRUE(queue.isFullFor(*other()));
}

TEST(ObservationQueue, DropsTheOldestOfAKindAndKeepsTheOrder)
{
	ObservationQueue queue(5);
	const auto a = other(), b = frame(), c = other(), d = frame();
	for (const auto& observation : {a, b, c, d}) queue.push(observation);
	queue.dropOldestLike(*frame());
	EXPECT_EQ(queue.frames(), 1u);
	queue.dropOldestLike(*other());
	EXPECT_EQ(queue.frames(), 1u);
	EXPECT_EQ(queue.pop(), c);
	EXPECT_EQ(queue.pop(), d);
	EXPECT_TRUE(queue.isEmpty());
}
