#include <filesystem>

#include "SemloopEvalFixture.h"

namespace semloop
{
namespace
{
using ::testing::HasSubstr;

class SemloopEvalAssociation : public SemloopEval
{
protected:
	/** Frames 100, 101, 102 s; object 1 becomes 10 thrice, object 2 becomes 20 and is missed once. */
	void SetUp() override
	{
		write("OUT/trajectory.tum", "100 0 0 0 0 0 0 1\n101 0 0 0 0 0 0 1\n102 0 0 0 0 0 0 1\n");
		write(
			"OUT/associations.csv",
			kAssociationHeading + associationLine(0, 1, 10, 10) + associationLine(1, 1, 10, 11) +
				associationLine(1, 2, 20, 20) + associationLine(2, 1, 10, 10));
		truth_ = writeTrueInstances(path("truth.rawlog"), {{1}, {1, 2}, {1, 2}});
		arguments_ = "association " + path("OUT") + " --truth " + truth_;
	}

	std::string truth_, arguments_;
};

TEST_F(SemloopEvalAssociation, CountsTheBoxesInTheRightObject)
{
	const auto result = json(arguments_);
	EXPECT_EQ(result["frames"], 3);
	EXPECT_EQ(result["true_boxes"], 5);
	EXPECT_EQ(result["detected_boxes"], 4);
	EXPECT_EQ(result["correct"], 4);
	EXPECT_EQ(result["accuracy"], 0.8);
	EXPECT_EQ(result["accuracy_of_detected"], 1.0);
	EXPECT_EQ(
		result["matches"][0], nlohmann::json({{"truth", 1}, {"object", 10}, {"shared_boxes", 3}}));
}

TEST_F(SemloopEvalAssociation, PrintsATableWithTheNumbersOfTheJson)
{
	const auto result = run(arguments_);
	EXPECT_EQ(result.exitCode, 0) << result.errors;
	EXPECT_THAT(result.output, HasSubstr("0.8000"));
	EXPECT_THAT(result.output, HasSubstr("1.0000"));
}

TEST_F(SemloopEvalAssociation, IsNullWhereNoTrueBoxIsLargeEnough)
{
	const auto result = json(arguments_ + " --minimum-pixels 101");
	EXPECT_EQ(result["true_boxes"], 0);
	EXPECT_TRUE(result["accuracy"].is_null());
	EXPECT_THAT(run(arguments_ + " --minimum-pixels 101").output, HasSubstr(" -\n"));
}

TEST_F(SemloopEvalAssociation, NamesWhatIsMissingWithARemedy)
{
	expectError("association " + path("none") + " --truth " + truth_, 1, {"none", "semloop-slam"});
	expectError(
		"association " + path("OUT") + " --truth " + path("none.rawlog"), 1,
		{"none.rawlog", "true instances"});
	expectError(arguments_ + " --images " + path("none.rawlog"), 1, {"none.rawlog", "made of"});
	expectError(arguments_ + " --images " + truth_, 1, {"no image is of the time"});
	std::filesystem::remove(path("OUT/associations.csv"));
	expectError(arguments_, 1, {"associations.csv", "run it again"});
}

TEST_F(SemloopEvalAssociation, RefusesATruthOfAnotherTimeOrWithoutTruth)
{
	writeTrueInstances(truth_, {{1}}, 500);
	expectError(arguments_, 1, {"OUT", "truth.rawlog", "one rawlog"});
	writeTrueInstances(truth_, {{}, {}});
	expectError(arguments_, 1, {"truth.rawlog", "which real object"});
}

TEST_F(SemloopEvalAssociation, ExitsWith2OnWrongUsage)
{
	expectError("association " + path("OUT"), 2, {"required"});
	expectError(arguments_ + " --minimum-pixels -1", 2, {"--minimum-pixels"});
}
}  // namespace
}  // namespace semloop
