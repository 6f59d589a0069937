#include <filesystem>

#include "SemloopEvalFixture.h"

namespace semloop
{
namespace
{
using ::testing::HasSubstr;

class SemloopEvalLoops : public SemloopEval
{
protected:
	/** Objects 1, 2, 3 in frames 0 and 2, mapped as 1, 2, 3 and then as 11, 12, 13; a right loop. */
	void SetUp() override
	{
		write("OUT/trajectory.tum", "100 0 0 0 0 0 0 1\n101 0 0 0 0 0 0 1\n102 0 0 0 0 0 0 1\n");
		std::string associations = kAssociationHeading;
		for (int i = 1; i <= 3; i++) associations += associationLine(0, i, i, i);
		for (int i = 1; i <= 3; i++) associations += associationLine(2, i, i, 10 + i);
		write("OUT/associations.csv", associations);
		write(
			"OUT/loops.jsonl",
			R"({"frame": 2, "local_map_since": 2, "decision": "accepted", "graphs_match": true, )"
			R"("candidates": [[11, 1], [12, 2], [13, 3]], "matches": [[11, 1], [12, 2]]})"
			"\n"
			R"({"frame": 2, "local_map_since": 2, "decision": "rejected", "graphs_match": true, )"
			R"("candidates": [[11, 2], [12, 1], [13, 3]], "matches": []})"
			"\n");
		truth_ = writeTrueInstances(path("truth.rawlog"), {{1, 2, 3}, {}, {1, 2, 3}});
		arguments_ = "loops " + path("OUT/loops.jsonl") + " --truth " + truth_;
	}

	std::string truth_, arguments_;
};

TEST_F(SemloopEvalLoops, CountsBeforeAndAfterTheVerification)
{
	const auto result = json(arguments_ + " --frames-apart 1");
	EXPECT_EQ(result["attempts"], 2);
	EXPECT_EQ(result["before_verification"]["detections"], 2);
	EXPECT_EQ(result["before_verification"]["true_positives"], 1);
	EXPECT_EQ(result["before_verification"]["precision"], 0.5);
	EXPECT_EQ(result["after_verification"]["detections"], 1);
	EXPECT_EQ(result["after_verification"]["precision"], 1.0);
	EXPECT_EQ(result["places"], 1);
	EXPECT_EQ(result["recall"], 1.0);
}

TEST_F(SemloopEvalLoops, ByThePapersNumbersThreeFramesHaveNoLoop)
{
	const auto result = json(arguments_);
	EXPECT_EQ(result["common_objects"], 2);
	EXPECT_EQ(result["frames_apart"], 500);
	EXPECT_EQ(result["after_verification"]["false_positives"], 1);
	EXPECT_TRUE(result["recall"].is_null());
}

TEST_F(SemloopEvalLoops, BothNumbersOfTheRuleAreOptions)
{
	EXPECT_EQ(json(arguments_ + " --frames-apart 1 --common-objects 3")["places"], 0);
	EXPECT_EQ(json(arguments_ + " --frames-apart 2")["places"], 0);
	EXPECT_EQ(json(arguments_ + " --frames-apart 1 --minimum-pixels 101")["places"], 0);
}

TEST_F(SemloopEvalLoops, PrintsATable)
{
	const auto result = run(arguments_ + " --frames-apart 1");
	EXPECT_EQ(result.exitCode, 0) << result.errors;
	EXPECT_THAT(result.output, HasSubstr("1 of 1 places found"));
	EXPECT_THAT(result.output, HasSubstr("0.5000"));
}

TEST_F(SemloopEvalLoops, NamesWhatIsMissingDamagedOrOfAnotherTime)
{
	expectError(
		"loops " + path("no.jsonl") + " --truth " + truth_, 1, {"no.jsonl", "semloop-slam"});
	expectError(
		"loops " + path("OUT/loops.jsonl") + " --truth " + path("no.rawlog"), 1, {"no.rawlog"});
	writeTrueInstances(truth_, {{1}}, 500);
	expectError(arguments_, 1, {"truth.rawlog", "one rawlog"});
	write("OUT/loops.jsonl", "{}\n");
	expectError(arguments_, 1, {"loops.jsonl:1", "frame"});
	write("OUT/loops.jsonl", "");
	std::filesystem::remove(path("OUT/trajectory.tum"));
	expectError(arguments_, 1, {"trajectory.tum", "run it again"});
}

TEST_F(SemloopEvalLoops, ExitsWith2OnWrongUsage)
{
	expectError("loops " + path("OUT/loops.jsonl"), 2, {"required"});
	for (const char* option : {"--common-objects", "--frames-apart", "--minimum-pixels"})
		expectError(arguments_ + " " + option + " -1", 2, {option});
}
}  // namespace
}  // namespace semloop
