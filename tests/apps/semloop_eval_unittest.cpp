#include "SemloopEvalFixture.h"

namespace semloop
{
namespace
{
using ::testing::HasSubstr;

TEST_F(SemloopEval, FindsNoErrorInAShiftedCopyAfterAlignment)
{
	const auto result =
		run("trajectory " + write("est.tum", square(5, -1)) + " " +
			write("truth.tum", square(0, 0)) + " --json");
	ASSERT_EQ(result.exitCode, 0) << result.errors;
	const auto json = nlohmann::json::parse(result.output);
	EXPECT_EQ(json["pairs"], 4);
	EXPECT_NEAR(json["ate_m"]["rmse"], 0, 1e-9);
	EXPECT_EQ(json["rpe_per_second"]["translation_m"]["count"], 2);
	EXPECT_NEAR(json["rpe_per_metre"]["translation_m"]["max"], 0, 1e-9);
}

TEST_F(SemloopEval, MeasuresTheShiftWithoutAlignment)
{
	const auto result =
		run("trajectory " + write("est.tum", square(0.3, 0.4)) + " " +
			write("truth.tum", square(0, 0)) + " --align none --json");
	ASSERT_EQ(result.exitCode, 0) << result.errors;
	EXPECT_NEAR(nlohmann::json::parse(result.output)["ate_m"]["rmse"], 0.5, 1e-9);
}

TEST_F(SemloopEval, HasTheFiguresOfTheBenchmarksScriptsForAPublishedPair)
{
	const std::string pair = SEMLOOP_SOURCE_DIR "/tests/evaluation/published_pair/";
	const auto result = run("trajectory " + pair + "estimate.tum " + pair + "truth.tum --json");
	ASSERT_EQ(result.exitCode, 0) << result.errors;
	const auto json = nlohmann::json::parse(result.output);
	EXPECT_NEAR(json["ate_m"]["rmse"], 0.008190, 5e-7);
	EXPECT_NEAR(json["rpe_per_second"]["translation_m"]["rmse"], 0.016135, 5e-7);
	EXPECT_NEAR(json["rpe_per_second"]["rotation_deg"]["rmse"], 0.788560, 5e-7);
}

TEST_F(SemloopEval, PrintsATableWhoseNumbersAreThoseOfTheJson)
{
	const auto result =
		run("trajectory " + write("est.tum", square(0.25, 0)) + " " +
			write("truth.tum", square(0, 0)) + " --align none");
	ASSERT_EQ(result.exitCode, 0) << result.errors;
	EXPECT_THAT(result.output, HasSubstr("4 of 4 estimated poses"));
	EXPECT_THAT(result.output, HasSubstr("0.2500"));
	EXPECT_EQ(result.errors, "");
}

TEST_F(SemloopEval, WhatWasNotMeasuredIsNullInTheJson)
{
	const std::string standing = "100 0 0 0 0 0 0 1\n101 0 0 0 0 0 0 1\n102 0 0 0 0 0 0 1\n";
	const auto result = run(
		"trajectory " + write("est.tum", standing) + " " + write("truth.tum", standing) +
		" --align none --json");
	ASSERT_EQ(result.exitCode, 0) << result.errors;
	const auto perMetre = nlohmann::json::parse(result.output)["rpe_per_metre"]["translation_m"];
	EXPECT_EQ(perMetre["count"], 0);
	for (const std::string name : {"rmse", "mean", "median", "max"})
		EXPECT_TRUE(perMetre.at(name).is_null()) << name;
}

TEST_F(SemloopEval, NamesAMissingFileAndExitsWith1)
{
	const auto result =
		run("trajectory " + path("missing.tum") + " " + write("truth.tum", square(0, 0)));
	EXPECT_EQ(result.exitCode, 1);
	EXPECT_THAT(result.errors, HasSubstr("missing.tum"));
	EXPECT_EQ(result.output, "");
}

TEST_F(SemloopEval, NamesTheLineOfAMalformedFileAndExitsWith1)
{
	const auto result =
		run("trajectory " + write("est.tum", "100 0 0 0 0 0 0 1\n101 0 0 zero 0 0 0 1\n") + " " +
			write("truth.tum", square(0, 0)));
	EXPECT_EQ(result.exitCode, 1);
	EXPECT_THAT(result.errors, HasSubstr("est.tum:2"));
}

TEST_F(SemloopEval, NamesBothFilesWhenTheirTimesDoNotMeetAndExitsWith1)
{
	const auto result = run(
		"trajectory " + write("est.tum", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n") +
		" " + write("truth.tum", square(0, 0)));
	EXPECT_EQ(result.exitCode, 1);
	EXPECT_THAT(result.errors, HasSubstr("est.tum"));
	EXPECT_THAT(result.errors, HasSubstr("truth.tum"));
	EXPECT_THAT(result.errors, HasSubstr("clock"));
}

TEST_F(SemloopEval, ExitsWith2OnWrongUsage)
{
	const std::string files =
		write("est.tum", square(0, 0)) + " " + write("truth.tum", square(0, 0));
	for (const std::string& arguments :
		 {std::string(), std::string("trajectry ") + files, std::string("trajectory"),
		  "trajectory " + files + " --align sim3",
		  "trajectory " + files + " --max-time-difference -1"})
	{
		const auto result = run(arguments);
		EXPECT_EQ(result.exitCode, 2) << arguments;
		EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1)
			<< arguments << ": " << result.errors;
	}
}

TEST_F(SemloopEval, ExplainsItself)
{
	const auto overview = run("--help");
	EXPECT_EQ(overview.exitCode, 0);
	for (const char* name : {"trajectory", "association", "loops", "objects"})
		EXPECT_THAT(overview.output, HasSubstr(std::string("  ") + name + " "));
	const auto command = run("trajectory --help");
	EXPECT_EQ(command.exitCode, 0);
	EXPECT_THAT(command.output, HasSubstr("--align"));
}
}  // namespace
}  // namespace semloop
