#include <gtest/gtest.h>
#include <mrpt/system/COutputLogger.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/FrameSource.h>
#include <semloop/slam/RunResults.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "SyntheticRun.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace semloop
{
/** Answers as the configuration says, and keeps what it was asked. */
class ScriptedDetector : public LoopDetector
{
	DEFINE_MRPT_OBJECT(ScriptedDetector, semloop)
public:
	struct Question
	{
		std::size_t query = 0, target = 0;
		std::optional<PosePrior> prior;
		std::size_t firstFrame = 0;
		mrpt::poses::CPose3D T_world_camera;  //!< of the last frame
	};
	static std::vector<Question> questions;
	static std::vector<std::size_t> frames;
	static std::size_t narrower;

	void configure(const mrpt::config::CConfigFileBase& config, const std::string& section) override
	{
		ambiguous_ = config.read_bool(section, "ambiguous", false);
	}
	void addFrame(std::size_t frame, const RgbdFrame& images) override
	{
		EXPECT_FALSE(images.color.empty());
		frames.push_back(frame);
	}
	LoopVerdict detect(const LoopQuery& asked) override
	{
		if (asked.prior)
		{
			// Not wider for one object than for all, which includes the oldest.
			const auto one = asked.priorOf({*asked.target.rbegin()});
			EXPECT_LE(one.sigmaXY, asked.prior->sigmaXY);
			narrower += one.sigmaXY < asked.prior->sigmaXY;
			const std::vector<ObjectId> all(asked.target.begin(), asked.target.end());
			EXPECT_EQ(asked.priorOf(all).sigmaXY, asked.prior->sigmaXY);
		}
		questions.push_back(
			{asked.query.size(), asked.target.size(), asked.prior, asked.firstFrame,
			 asked.T_world_camera(frames.back())});
		LoopVerdict verdict;
		if (ambiguous_) verdict.decision = LoopVerdict::Decision::Ambiguous;
		verdict.probability = 0.25;
		verdict.centreRmse = 0.5;
		return verdict;
	}

private:
	bool ambiguous_ = false;
};
std::vector<ScriptedDetector::Question> ScriptedDetector::questions;
std::vector<std::size_t> ScriptedDetector::frames;
std::size_t ScriptedDetector::narrower = 0;
}  // namespace semloop

IMPLEMENTS_MRPT_OBJECT(ScriptedDetector, semloop::LoopDetector, semloop)

namespace
{
/** Frames of the local map at each attempt, on a walk of 150 degrees round the room. */
std::vector<std::size_t> localMapLengths(bool ambiguous, std::string* lines = nullptr)
{
	mrpt::rtti::registerClass(CLASS_ID(ScriptedDetector));
	ScriptedDetector::questions.clear();
	ScriptedDetector::frames.clear();
	const TemporaryFolder folder;
	RunOptions options;
	options.degrees = 150;
	const RecordedRun recorded = recordRun(folder, options);
	auto config = runConfiguration(recorded, 0.3);
	config.write("modules", "loop_detector", "semloop::ScriptedDetector");
	config.write("loop_detection", "ambiguous", ambiguous);
	config.write("local_map", "length", 1.0);
	config.write("local_map", "growth", 0.5);
	mrpt::system::COutputLogger logger;
	logger.logging_enable_console_output = false;
	StageTimings timings;
	SemanticSlam slam(config, logger, timings);
	FrontEnd front = makeFrontEnd(config);
	FrameSource source(std::make_unique<RawlogReader>(recorded.rawlog), front, 0, timings);
	while (auto frame = source.next()) slam.process(*frame);
	std::vector<std::size_t> lengths;
	for (const auto& record : slam.loops()) lengths.push_back(record.frame - record.localMapSince);
	if (lines) *lines = loopsAsJsonLines(slam.loops());
	return lengths;
}
}  // namespace

TEST(LoopDetection, IsToldWhatOdometrySaysOfTheDriftSinceTheRestWasSeen)
{
	std::string lines;
	localMapLengths(false, &lines);
	const auto& questions = ScriptedDetector::questions;
	ASSERT_GT(questions.size(), 5u);
	double first = 0, last = 0;
	for (const auto& question : questions)
	{
		ASSERT_EQ(question.prior.has_value(), question.query > 0 && question.target > 0);
		if (!question.prior) continue;
		EXPECT_EQ(question.prior->T_target_query, CPose3D());
		// 0.3 m are the loop closure's own; the drift comes on top and grows.
		EXPECT_GT(question.prior->sigmaXY, 0.3);
		if (first == 0) first = question.prior->sigmaXY;
		last = question.prior->sigmaXY;
	}
	EXPECT_FALSE(questions.front().prior.has_value()) << "everything is in the local map";
	ASSERT_TRUE(questions.back().prior.has_value());
	EXPECT_GT(last, first + 0.001);
	EXPECT_GT(ScriptedDetector::narrower, 0u);

	std::istringstream stream(lines);
	std::string line;
	nlohmann::json written;
	while (std::getline(stream, line)) written = nlohmann::json::parse(line);
	EXPECT_EQ(written["prior"]["sigma_xy"], last);
	EXPECT_EQ(written["probability"], 0.25);
	EXPECT_EQ(written["centre_rmse"], 0.5);
	for (const char* notEstimated : {"evidence", "runner_up", "alignment_fitness"})
		EXPECT_TRUE(written.at(notEstimated).is_null()) << notEstimated;
}

TEST(LoopDetection, IsShownEveryFrameAndKnowsTheCameras)
{
	localMapLengths(false);
	const auto& frames = ScriptedDetector::frames;
	ASSERT_GT(frames.size(), 20u);
	for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i], i);
	const auto& questions = ScriptedDetector::questions;
	EXPECT_EQ(questions.front().firstFrame, 0u);
	EXPECT_GT(questions.back().firstFrame, 0u);
	// The walk goes round the middle of the room.
	const auto &first = questions.front().T_world_camera, &last = questions.back().T_world_camera;
	EXPECT_GT((last.translation() - first.translation()).norm(), 1.0);
}

TEST(LoopDetection, AnAmbiguousAnswerKeepsTheLocalMapGrowing)
{
	const auto rejected = localMapLengths(false), ambiguous = localMapLengths(true);
	ASSERT_EQ(rejected.size(), ambiguous.size());
	EXPECT_EQ(rejected.front(), ambiguous.front());
	// Half a metre longer at the end, and no more: a third of it.
	EXPECT_GT(double(ambiguous.back()), 1.3 * double(rejected.back()));
	EXPECT_LT(double(ambiguous.back()), 1.7 * double(rejected.back()));
}
