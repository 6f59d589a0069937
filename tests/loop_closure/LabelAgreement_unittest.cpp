#include <gtest/gtest.h>
#include <semloop/loop_closure/LabelAgreement.h>
#include <semloop/loop_closure/PlaceSearch.h>

#include <cmath>
#include <fstream>

#include "GraphFixtures.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;

ConfusionMatrix confusionOf(const std::string& rows)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("confusion.json");
	std::ofstream(path) << R"({"format": "semloop.confusion/1", "labels": ["x", "y"], "p": )"
						<< rows << "}";
	return ConfusionMatrix::load(path);
}

TEST(LabelAgreement, WithoutAMatrixTheRestIsSpreadEvenly)
{
	const LabelAgreement agreement(0.9);
	EXPECT_DOUBLE_EQ(agreement.probability("chair", "chair", 5), 0.9);
	EXPECT_NEAR(agreement.probability("couch", "chair", 5), 0.025, 1e-12);
	EXPECT_NEAR(agreement.probability("couch", "chair", 1), 0.1, 1e-12);
}

TEST(LabelAgreement, BothObservationsAreOfOneUnknownTrueLabel)
{
	const LabelAgreement agreement(0.9, confusionOf("[[0.8, 0.2], [0.4, 0.6]]"));
	// Called x: 0.8 when it is an x, 0.4 when it is a y, so it is an x with 2/3.
	EXPECT_NEAR(agreement.probability("x", "x", 2), 2 / 3.0 * 0.8 + 1 / 3.0 * 0.4, 1e-6);
	EXPECT_NEAR(agreement.probability("y", "x", 2), 2 / 3.0 * 0.2 + 1 / 3.0 * 0.6, 1e-6);
	// Called y: 0.2 and 0.6.
	EXPECT_NEAR(agreement.probability("x", "y", 2), 1 / 4.0 * 0.8 + 3 / 4.0 * 0.4, 1e-6);
	EXPECT_NEAR(agreement.probability("y", "y", 2), 1 / 4.0 * 0.2 + 3 / 4.0 * 0.6, 1e-6);
	EXPECT_DOUBLE_EQ(agreement.probability("z", "z", 2), 0.9) << "not in the matrix";
}

/** Four objects; the query calls the first a chair. */
class LabelScores : public testing::Test
{
protected:
	static SemanticGraph roomWith(
		const std::string& label, const std::map<std::string, double>& scores)
	{
		auto room = complete(
			{vertex(0, label, -1, 0, 0.5), vertex(1, "table", 1, 0, 0.5),
			 vertex(2, "lamp", 0, 1.5, 1.5), vertex(3, "shelf", 1.5, 1.5, 1)});
		room.vertices[0].labelScores = scores;
		return room;
	}
	static Place find(
		const SemanticGraph& target, const LabelAgreement& agreement = LabelAgreement())
	{
		const GraphIndex index(target);
		return PlaceSearch(roomWith("chair", {}), index, agreement, {}).places().found.at(0);
	}
};

TEST_F(LabelScores, AnObjectThatMayBeAChairIsACandidateForOne)
{
	EXPECT_EQ(find(roomWith("stool", {})).matches.size(), 3u);
	EXPECT_EQ(find(roomWith("stool", {{"stool", 0.6}, {"chair", 0.4}})).matches.size(), 4u);
}

TEST_F(LabelScores, WeighTheEvidence)
{
	const double certain = find(roomWith("chair", {{"chair", 1}})).evidence;
	EXPECT_EQ(certain, find(roomWith("chair", {})).evidence);
	EXPECT_EQ(certain, find(roomWith("chair", {{"chair", 0.5}})).evidence) << "scores of one label";
	// 0.92 when both call it a chair; four labels share the rest.
	const double doubtful = find(roomWith("chair", {{"chair", 0.6}, {"stool", 0.2}})).evidence;
	EXPECT_NEAR(doubtful - certain, std::log(0.75 + 0.25 * (0.08 / 3) / 0.92), 1e-5);
}

TEST_F(LabelScores, AConfusionMatrixMakesCandidatesOfWhatIsMistaken)
{
	auto room = roomWith("y", {});
	const GraphIndex index(room);
	const auto query = roomWith("x", {});
	const auto matches = [&](const LabelAgreement& agreement)
	{ return PlaceSearch(query, index, agreement, {}).places().found.at(0).matches.size(); };
	EXPECT_EQ(matches(LabelAgreement(0.92, confusionOf("[[0.99, 0.01], [0.01, 0.99]]"))), 3u);
	EXPECT_EQ(matches(LabelAgreement(0.92, confusionOf("[[0.7, 0.3], [0.3, 0.7]]"))), 4u);
}
}  // namespace
