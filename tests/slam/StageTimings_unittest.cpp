#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/slam/StageTimings.h>

#include "TemporaryFolder.h"

using namespace semloop;

TEST(StageTimings, SummarisesByTheNearestRankRule)
{
	StageTimings timings;
	for (int i = 100; i >= 1; --i) timings.add("fusion", i);
	const auto s = timings.summaries().at("fusion");
	EXPECT_EQ(s.count, 100u);
	EXPECT_DOUBLE_EQ(s.mean, 50.5);
	EXPECT_DOUBLE_EQ(s.p50, 50);
	EXPECT_DOUBLE_EQ(s.p95, 95);
	EXPECT_DOUBLE_EQ(s.max, 100);
}

TEST(StageTimings, TotalsAreCountAndSum)
{
	StageTimings timings;
	for (int i = 100; i >= 1; --i) timings.add("fusion", i);
	timings.add("read", 2.5);
	EXPECT_EQ(timings.totals().size(), 2u);
	EXPECT_EQ(timings.totals().at("fusion").count, 100u);
	EXPECT_DOUBLE_EQ(timings.totals().at("fusion").milliseconds, 5050);
}

TEST(StageTimings, TheSummaryHasTheTotalItself)
{
	StageTimings timings;
	// A tenth is no float: the sum of rounded samples is another one.
	for (int i = 0; i < 3; ++i) timings.add("read", 0.1);
	EXPECT_EQ(timings.totals().at("read").milliseconds, 0.1 + 0.1 + 0.1);
	EXPECT_EQ(timings.summaries().at("read").milliseconds, 0.1 + 0.1 + 0.1);
}

TEST(StageTimings, OneSampleIsEveryPercentile)
{
	StageTimings timings;
	timings.add("read", 4);
	const auto s = timings.summaries().at("read");
	EXPECT_DOUBLE_EQ(s.p50, 4);
	EXPECT_DOUBLE_EQ(s.p95, 4);
}

TEST(StageTimings, NoSamplesGiveOnlyTheHeadingOfTheTable)
{
	const TemporaryFolder folder;
	StageTimings().writeCsv(folder.file("timings.csv"));
	EXPECT_EQ(readBytes(folder.file("timings.csv")), "stage,count,mean_ms,p50_ms,p95_ms,max_ms\n");
}

TEST(StageTimings, AScopeCountsOnce)
{
	StageTimings timings;
	{
		const StageTimings::Scope scope(timings, "tracking");
	}
	EXPECT_EQ(timings.summaries().at("tracking").count, 1u);
}

TEST(StageTimings, AFileThatCannotBeWrittenIsNamed)
{
	EXPECT_THROW(StageTimings().writeCsv("/no/such/folder/timings.csv"), InputError);
}
