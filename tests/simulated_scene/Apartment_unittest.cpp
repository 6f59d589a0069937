#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/evaluation/LoopEvaluation.h>
#include <semloop/evaluation/ObjectEvaluation.h>
#include <semloop/evaluation/TrajectoryError.h>
#include <semloop/evaluation/TrueFrames.h>
#include <semloop/observations/Trajectory.h>

#include <filesystem>
#include <string>

#include "TemporaryFolder.h"

/** What `make demo` made of the simulated flat, walked round twice, back in the opposite direction; see
 *  prepare.sh. */
namespace semloop
{
namespace
{
const std::string kDemo = SEMLOOP_BINARY_DIR "/simulated_scene/";

class Apartment : public testing::Test
{
protected:
	void SetUp() override
	{
		if (!std::filesystem::exists(kDemo + "demo.txt")) GTEST_SKIP() << "there is no simulation";
	}

	/** Of a file of the run, after alignment [m]. */
	static AbsoluteTrajectoryError errorOf(const std::string& trajectory)
	{
		return absoluteTrajectoryError(associateByTime(
			readTumTrajectory(kDemo + "result/" + trajectory),
			readTumTrajectory(kDemo + "apartment_groundtruth.tum")));
	}
};

TEST_F(Apartment, TheErrorFallsToAQuarterOfTheOdometrysAndBelowATenthOfAMetre)
{
	const double odometry = errorOf("trajectory_odometry.tum").translation.rmse;
	const double closed = errorOf("trajectory.tum").translation.rmse;
	EXPECT_GT(odometry, 0.2) << "too good to show anything";
	EXPECT_LT(closed, 0.25 * odometry);
	EXPECT_LT(closed, 0.10);
}

TEST_F(Apartment, LoopsAreClosedAndNoneIsFalse)
{
	const std::string run = kDemo + "result/";
	const auto frames = joinWithTruth(
		readTumTrajectory(run + "trajectory.tum"), readAssociations(run + "associations.csv"),
		readTrueFrames(kDemo + "apartment_truth_instances.rawlog"));
	LoopRule rule;
	rule.framesApart = 166;  // the paper's 500 at a third of the rate
	const auto loops = evaluateLoops(readLoopAttempts(run + "loops.jsonl"), frames, rule);
	EXPECT_GE(loops.verified.truePositives, 3u);
	EXPECT_EQ(loops.verified.falsePositives, 0u);
}

TEST_F(Apartment, MostObjectsAreFoundOnceWithTheirLabel)
{
	const auto objects = evaluateObjects(
		SemanticGraph::load(kDemo + "result/objects.json"),
		SemanticGraph::load(kDemo + "apartment_objects.json"),
		errorOf("trajectory.tum").T_truth_estimate);
	EXPECT_GT(objects.recall.value(), 0.8);
	EXPECT_GT(objects.precision.value(), 0.8);
	EXPECT_GT(objects.labelAccuracy.value(), 0.95);
	EXPECT_LT(objects.centreError.median, 0.15);
}

TEST_F(Apartment, TheDemoEndsWithItsFigures)
{
	const std::string text = readBytes(kDemo + "demo.txt");
	for (const std::string line :
		 {"trajectory error of the odometry", "after semantic loop closure", "true, 0 false",
		  "objects found", "time a frame", "scene.3Dscene"})
		EXPECT_THAT(text, testing::HasSubstr(line));
}
}  // namespace
}  // namespace semloop
