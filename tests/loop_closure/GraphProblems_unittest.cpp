#include <gtest/gtest.h>
#include <semloop/loop_closure/PlaceRecognizer.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "GraphFixtures.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;

/** The published matching problems, unpacked. */
class GraphProblems : public testing::Test
{
protected:
	void SetUp() override
	{
		const char* data = std::getenv("SEMLOOP_DATA");
		if (!data) GTEST_SKIP() << "SEMLOOP_DATA is not set";
		const std::string archive = std::string(data) + "/data/graph_matching/problems.tar.xz";
		if (!std::filesystem::exists(archive)) GTEST_SKIP() << "SEMLOOP_DATA has no " << archive;
		const std::string unpack = "tar -xf '" + archive + "' -C '" + folder.path().string() + "'";
		ASSERT_EQ(std::system(unpack.c_str()), 0) << unpack;
	}

	SemanticGraph load(const std::string& name) const
	{
		return SemanticGraph::load(folder.file(name));
	}

	TemporaryFolder folder;
};

TEST_F(GraphProblems, AllFilesLoad)
{
	int graphs = 0;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
	{
		if (entry.path().extension() != ".json" || entry.path().filename() == "truth.json")
			continue;
		EXPECT_NO_THROW(SemanticGraph::load(entry.path().string())) << entry.path();
		++graphs;
	}
	EXPECT_GT(graphs, 480);
}

/** The answers to all problems of a kind, with and without the prior. */
struct Answers
{
	int positives = 0, negatives = 0, accepted = 0, right = 0, acceptedForeign = 0;
};

Answers answersTo(const std::string& folder, bool usePrior)
{
	const PlaceRecognizer recognizer;
	Answers answers;
	for (const auto& problem : nlohmann::json::parse(readBytes(folder + "/truth.json")))
	{
		const auto poseFrom = [](const nlohmann::json& numbers)
		{
			mrpt::math::CMatrixDouble44 matrix;
			for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = numbers[i].get<double>();
			return mrpt::poses::CPose3D(matrix);
		};
		const auto query = SemanticGraph::load(folder + "/" + problem["query"].get<std::string>());
		const auto target =
			SemanticGraph::load(folder + "/" + problem["target"].get<std::string>());
		std::optional<PosePrior> prior;
		if (usePrior) prior = PosePrior{poseFrom(problem["prior"])};
		const auto verdict = recognizer.recognize(query, target, GraphIndex(target), prior);
		const bool accepted = verdict.decision == LoopVerdict::Decision::Accepted;
		const bool negative = problem["negative"].get<bool>();
		(negative ? answers.negatives : answers.positives)++;
		answers.accepted += accepted;
		answers.acceptedForeign += accepted && negative;
		if (negative || !accepted) continue;
		const auto error = verdict.T_target_query - poseFrom(problem["T_target_query"]);
		mrpt::math::TPoint3D centre;
		for (const auto& v : query.vertices) centre += v.position * (1.0 / query.vertices.size());
		const double distance = (verdict.T_target_query.composePoint(centre) -
								 poseFrom(problem["T_target_query"]).composePoint(centre))
									.norm();
		answers.right += distance < 0.4 && fixtures::rotationAngle(error) < 0.2;
	}
	return answers;
}

struct Bound
{
	const char* kind;
	double precision, recall;            // at least, without the prior [%]
	double priorPrecision, priorRecall;  // same, with it
};

class GraphProblemsOfKind : public GraphProblems, public testing::WithParamInterface<Bound>
{
};

TEST_P(GraphProblemsOfKind, AreAnsweredAsWellAsTheyMustBe)
{
	const auto& bound = GetParam();
	for (const bool usePrior : {false, true})
	{
		const auto answers = answersTo(folder.file(bound.kind), usePrior);
		EXPECT_EQ(answers.positives, 20);
		EXPECT_EQ(answers.negatives, 20);
		EXPECT_EQ(answers.acceptedForeign, 0) << (usePrior ? "with prior" : "without");
		// One of twenty is 5 %; larger sets are in doc/loop-detection.md.
		const int unlucky = usePrior ? 0 : 1;
		EXPECT_GE(
			answers.right + unlucky,
			std::ceil((usePrior ? bound.priorRecall : bound.recall) * 0.01 * answers.positives));
		EXPECT_GE(
			answers.right + unlucky,
			std::ceil(
				(usePrior ? bound.priorPrecision : bound.precision) * 0.01 * answers.accepted));
	}
}

INSTANTIATE_TEST_SUITE_P(
	PlaceRecognizer, GraphProblemsOfKind,
	testing::Values(
		Bound{"clean", 100, 97, 100, 99}, Bound{"mild", 100, 97, 100, 99},
		Bound{"partial_objects", 100, 97, 100, 99}, Bound{"cluttered", 100, 97, 100, 98},
		Bound{"hard", 97, 88, 98, 90}, Bound{"semi_repeated", 98, 92, 100, 95},
		Bound{"four_objects", 99, 80, 100, 93}, Bound{"six_objects", 99, 80, 100, 93},
		Bound{"repeated", 98, 0, 100, 88}, Bound{"identical_desks", 99, 0, 99, 0},
		Bound{"identical_desks_room", 100, 90, 100, 98}, Bound{"large_map", 100, 97, 100, 97}),
	[](const auto& testInfo) { return testInfo.param.kind; });
}  // namespace
