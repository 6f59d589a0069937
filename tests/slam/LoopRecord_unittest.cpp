#include <gtest/gtest.h>
#include <semloop/slam/LoopRecord.h>

using namespace semloop;
using Decision = LoopVerdict::Decision;

TEST(LoopRecord, AmbiguousAttemptsAreCountedApartFromRejectedOnes)
{
	std::vector<LoopRecord> loops;
	EXPECT_EQ(countLoops(loops, Decision::Accepted), 0u);
	for (const auto decision :
		 {Decision::Ambiguous, Decision::Rejected, Decision::Accepted, Decision::Rejected,
		  Decision::Ambiguous, Decision::Rejected})
	{
		loops.emplace_back();
		loops.back().verdict.decision = decision;
	}
	EXPECT_EQ(countLoops(loops, Decision::Accepted), 1u);
	EXPECT_EQ(countLoops(loops, Decision::Ambiguous), 2u);
	EXPECT_EQ(countLoops(loops, Decision::Rejected), 3u);
}
