#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/LoopEvaluation.h>

#include "EvaluationFixtures.h"
#include "TemporaryFolder.h"

namespace semloop
{
namespace
{
using namespace fixtures;
using ::testing::AllOf;
using ::testing::HasSubstr;

LoopAttempt attemptAt(std::size_t frame, std::size_t since, LoopAttempt::IdPairs pairs)
{
	LoopAttempt attempt;
	attempt.frame = frame;
	attempt.localMapSince = since;
	attempt.detected = attempt.accepted = true;
	attempt.candidates = attempt.matches = std::move(pairs);
	return attempt;
}

/** Objects 1, 2, 3 and then 4, 5, 6; back at 1, 2, 3 in frame 600, where the map has new ids for them. */
class LoopEvaluationTest : public ::testing::Test
{
protected:
	std::vector<RunFrame> frames{
		frameWith(0, {{1, 10}, {2, 20}, {3, 30}}), frameWith(300, {{4, 40}, {5, 50}, {6, 60}}),
		frameWith(600, {{1, 11}, {2, 21}, {3, 31}})};
	const LoopAttempt::IdPairs right{{11, 10}, {21, 20}, {31, 30}};
	const LoopAttempt::IdPairs wrong{{11, 40}, {21, 50}, {31, 60}};
};

TEST_F(LoopEvaluationTest, ARightLoopIsATruePositiveAndFindsItsPlace)
{
	const auto result = evaluateLoops({attemptAt(600, 550, right)}, frames);
	EXPECT_EQ(result.attempts, 1u);
	EXPECT_EQ(result.detected.truePositives, 1u);
	EXPECT_EQ(result.verified.truePositives, 1u);
	EXPECT_EQ(result.verified.falsePositives, 0u);
	EXPECT_EQ(result.verified.precision, 1.0);
	EXPECT_EQ(result.loopFrames, 1u);
	EXPECT_EQ(result.places, 1u);
	EXPECT_EQ(result.recall, 1.0);
}

TEST_F(LoopEvaluationTest, WrongPairsAreAFalsePositiveEvenWhereALoopIs)
{
	const auto result = evaluateLoops({attemptAt(600, 550, wrong)}, frames);
	EXPECT_EQ(result.verified.falsePositives, 1u);
	EXPECT_EQ(result.verified.precision, 0.0);
	EXPECT_EQ(result.recall, 0.0);
}

TEST_F(LoopEvaluationTest, AClaimByImagesIsJudgedByItsTwoFrames)
{
	LoopAttempt claim = attemptAt(620, 550, {});
	claim.cameras = {{600, 0}};
	const auto byImages = evaluateLoops({claim}, frames);
	EXPECT_EQ(byImages.detected.truePositives, 1u);
	EXPECT_EQ(byImages.verified.truePositives, 1u);
	EXPECT_EQ(byImages.recall, 1.0);
	// Other objects in the earlier frame; too near in time; taken back after the images agreed.
	claim.cameras = {{600, 300}};
	EXPECT_EQ(evaluateLoops({claim}, frames).verified.falsePositives, 1u);
	LoopRule rule;
	rule.framesApart = 600;
	claim.cameras = {{600, 0}};
	EXPECT_EQ(evaluateLoops({claim}, frames, rule).verified.falsePositives, 1u);
	claim.accepted = false;
	EXPECT_EQ(evaluateLoops({claim}, frames).detected.truePositives, 1u);
	EXPECT_EQ(evaluateLoops({claim}, frames).verified.detections, 0u);
}

TEST_F(LoopEvaluationTest, MoreThanHalfOfThePairsDecide)
{
	const LoopAttempt::IdPairs half{{11, 10}, {21, 50}}, most{{11, 10}, {21, 20}, {31, 60}};
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, half)}, frames).verified.truePositives, 0u);
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, most)}, frames).verified.truePositives, 1u);
}

TEST_F(LoopEvaluationTest, TwoObjectsInCommonAreNoLoopThreeAre)
{
	frames[0].truth.pop_back();
	frames[0].estimate.pop_back();
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, right)}, frames).verified.truePositives, 0u);
	LoopRule rule;
	rule.commonObjects = 1;
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, right)}, frames, rule).verified.truePositives, 1u);
}

TEST_F(LoopEvaluationTest, FramesHaveToBeMoreThanTheLimitApart)
{
	LoopRule rule;
	rule.framesApart = 600;
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, right)}, frames, rule).places, 0u);
	rule.framesApart = 599;
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, right)}, frames, rule).places, 1u);
}

TEST_F(LoopEvaluationTest, TheFramesOfTheLocalMapCountTogetherAndNotAsTheirOwnPast)
{
	// Frame 600 sees two of the three objects, frame 580 the third.
	frames.insert(frames.end() - 1, frameWith(580, {{3, 31}}));
	frames.back() = frameWith(600, {{1, 11}, {2, 21}});
	EXPECT_EQ(evaluateLoops({attemptAt(600, 580, right)}, frames).verified.truePositives, 1u);
	EXPECT_EQ(evaluateLoops({attemptAt(600, 590, right)}, frames).verified.truePositives, 0u);
	EXPECT_EQ(evaluateLoops({attemptAt(600, 0, right)}, frames).verified.truePositives, 0u)
		<< "the local map goes back to the first frame";
}

TEST_F(LoopEvaluationTest, SmallMasksAreNotObserved)
{
	frames[0].truth[0].pixels = 49;
	LoopRule rule;
	rule.minimumPixels = 50;
	EXPECT_EQ(evaluateLoops({}, frames, rule).places, 0u);
	rule.minimumPixels = 49;
	EXPECT_EQ(evaluateLoops({}, frames, rule).places, 1u);
}

TEST_F(LoopEvaluationTest, AnObjectIsWhatMostOfItsDetectionsUntilThenWere)
{
	// Object 11 takes in two detections of real object 4 behind the loop: they come too late to count.
	frames.push_back(frameWith(601, {{4, 11}}));
	frames.push_back(frameWith(602, {{4, 11}}));
	const LoopAttempt::IdPairs single{{11, 10}};
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, single)}, frames).verified.truePositives, 1u);
	EXPECT_EQ(evaluateLoops({attemptAt(602, 550, single)}, frames).verified.truePositives, 0u);
}

TEST_F(LoopEvaluationTest, AfterAMergeTheIdsOfTheTimeStillTellTheObjects)
{
	// A wrong loop made 11 a part of 40: in the end both have one id.
	for (auto& frame : frames)
		for (auto& record : frame.estimate)
			if (record.firstObject == 11) record.object = 40;
	const LoopAttempt::IdPairs single{{11, 40}};
	EXPECT_EQ(evaluateLoops({attemptAt(600, 550, single)}, frames).verified.falsePositives, 1u);
}

TEST_F(LoopEvaluationTest, DetectionsAreCountedByTheirCandidatesBeforeTheVerification)
{
	auto refuted = attemptAt(600, 550, right);
	refuted.candidates = wrong;
	refuted.accepted = false;
	auto nothing = refuted;
	nothing.detected = false;
	auto cleaned = attemptAt(600, 550, right);
	cleaned.candidates = wrong;
	const auto result = evaluateLoops({refuted, nothing, cleaned}, frames);
	EXPECT_EQ(result.attempts, 3u);
	EXPECT_EQ(result.detected.detections, 2u);
	EXPECT_EQ(result.detected.falsePositives, 2u);
	EXPECT_EQ(result.verified.detections, 1u);
	EXPECT_EQ(result.verified.truePositives, 1u);
}

TEST_F(LoopEvaluationTest, RecallCountsPlacesAndNotFrames)
{
	// Two runs of loop frames, 600-601 and 603; only the first is found, twice.
	frames.push_back(frameWith(601, {{1, 11}, {2, 21}, {3, 31}}));
	frames.push_back(frameWith(602, {{7, 70}}));
	frames.push_back(frameWith(603, {{1, 11}, {2, 21}, {3, 31}}));
	const auto result =
		evaluateLoops({attemptAt(600, 550, right), attemptAt(601, 550, right)}, frames);
	EXPECT_EQ(result.loopFrames, 3u);
	EXPECT_EQ(result.places, 2u);
	EXPECT_EQ(result.placesFound, 1u);
	EXPECT_EQ(result.recall, 0.5);
}

TEST_F(LoopEvaluationTest, WithoutALoopRecallIsEmptyAndWithoutADetectionPrecisionIs)
{
	frames.pop_back();
	const auto result = evaluateLoops({}, frames);
	EXPECT_EQ(result.places, 0u);
	EXPECT_FALSE(result.recall);
	EXPECT_FALSE(result.detected.precision);
	EXPECT_FALSE(result.verified.precision);
	EXPECT_EQ(evaluateLoops({}, {}).places, 0u);
}

const char* const kLine =
	R"({"frame": 7, "local_map_since": 3, "decision": "accepted", "matches": [[4, 1]],
"candidates": [[4, 1], [5, 2]], "graphs_match": true, "reason": "it fits"})";

std::string oneLine(std::string text)
{
	for (char& c : text)
		if (c == '\n') c = ' ';
	return text + "\n";
}

TEST(LoopAttempts, AreReadFromTheLines)
{
	const TemporaryFolder folder;
	const auto attempts = readLoopAttempts(folder.write("loops.jsonl", oneLine(kLine)));
	ASSERT_EQ(attempts.size(), 1u);
	EXPECT_EQ(attempts[0].frame, 7u);
	EXPECT_EQ(attempts[0].localMapSince, 3u);
	EXPECT_TRUE(attempts[0].detected);
	EXPECT_TRUE(attempts[0].accepted);
	EXPECT_EQ(attempts[0].candidates, (LoopAttempt::IdPairs{{4, 1}, {5, 2}}));
	EXPECT_EQ(attempts[0].matches, (LoopAttempt::IdPairs{{4, 1}}));
	EXPECT_TRUE(attempts[0].cameras.empty());
	EXPECT_TRUE(readLoopAttempts(folder.write("none.jsonl", "")).empty());

	std::string byImages = oneLine(kLine);
	byImages.insert(1, R"("cameras": [[600, 20, 31]], )");
	EXPECT_EQ(
		readLoopAttempts(folder.write("images.jsonl", byImages))[0].cameras,
		(std::vector<std::pair<std::size_t, std::size_t>>{{600, 20}}));
}

TEST(LoopAttempts, ErrorsNameFileAndLine)
{
	const TemporaryFolder folder;
	const auto errorOf = [&](const std::string& text)
	{ return messageOf<InputError>([&] { readLoopAttempts(folder.write("loops.jsonl", text)); }); };
	EXPECT_THAT(errorOf(oneLine(kLine) + "{\n"), HasSubstr("loops.jsonl:2"));
	EXPECT_THAT(errorOf("{\"frame\": 7}\n"), AllOf(HasSubstr(":1"), HasSubstr("local_map_since")));
	EXPECT_THAT(
		messageOf<InputError>([&] { readLoopAttempts(folder.file("missing.jsonl")); }),
		HasSubstr("missing.jsonl: cannot be read"));
}
}  // namespace
}  // namespace semloop
