#include <gtest/gtest.h>
#include <semloop/evaluation/ObjectEvaluation.h>

#include <cmath>

namespace semloop
{
namespace
{
using mrpt::poses::CPose3D;

GraphVertex object(ObjectId id, const std::string& label, double x, double y = 0)
{
	GraphVertex vertex;
	vertex.id = id;
	vertex.label = label;
	vertex.position = {x, y, 0};
	return vertex;
}

GraphVertex boxed(GraphVertex vertex, double sx, double sy, double sz)
{
	vertex.extent.emplace(sx, sy, sz);
	return vertex;
}

SemanticGraph graphOf(std::vector<GraphVertex> vertices)
{
	SemanticGraph graph;
	graph.vertices = std::move(vertices);
	return graph;
}

TEST(ObjectEvaluation, OfAPerfectMapIsPerfect)
{
	const auto graph = graphOf({boxed(object(1, "cup", 0), 1, 1, 1), object(2, "chair", 3)});
	const auto result = evaluateObjects(graph, graph);
	EXPECT_EQ(result.precision, 1.0);
	EXPECT_EQ(result.recall, 1.0);
	EXPECT_EQ(result.labelAccuracy, 1.0);
	EXPECT_NEAR(*result.meanBoxIou, 1, 1e-12);
	EXPECT_EQ(result.centreError.max, 0);
	EXPECT_TRUE(result.duplicates.empty());
}

TEST(ObjectEvaluation, CountsWhatIsMissingInventedAndWronglyLabelled)
{
	const auto result = evaluateObjects(
		graphOf({object(1, "cup", 0.3), object(2, "couch", 3.1), object(3, "lamp", 50)}),
		graphOf(
			{object(7, "cup", 0), object(8, "chair", 3), object(9, "tv", 6), object(10, "tv", 8)}));
	EXPECT_DOUBLE_EQ(*result.precision, 2.0 / 3);
	EXPECT_DOUBLE_EQ(*result.recall, 0.5);
	EXPECT_EQ(result.labelAccuracy, 0.5);
	EXPECT_NEAR(result.centreError.mean, 0.2, 1e-12);
	EXPECT_FALSE(result.meanBoxIou);
	ASSERT_EQ(result.matches.size(), 2u);
	EXPECT_EQ(result.matches[1].truth, 8u);
	EXPECT_FALSE(result.matches[1].sameLabel);
}

TEST(ObjectEvaluation, CarriesTheMapIntoTheTrueWorld)
{
	// A quarter turn and a shift: x becomes y.
	const CPose3D T_truth_estimate(10, 0, 0, M_PI / 2, 0, 0);
	const auto result = evaluateObjects(
		graphOf({boxed(object(1, "cup", 2), 2, 1, 1)}),
		graphOf({boxed(object(1, "cup", 10, 2), 1, 2, 1)}), T_truth_estimate);
	EXPECT_NEAR(result.centreError.max, 0, 1e-12);
	EXPECT_NEAR(*result.meanBoxIou, 1, 1e-9);
}

TEST(ObjectEvaluation, TurnsABoxByItsOrientation)
{
	auto turned = boxed(object(1, "cup", 0), 2, 1, 1);
	turned.orientation.emplace(std::sqrt(0.5), 0, 0, std::sqrt(0.5));  // about z by a quarter
	const auto result =
		evaluateObjects(graphOf({boxed(object(1, "cup", 0), 1, 2, 1)}), graphOf({turned}));
	EXPECT_NEAR(*result.meanBoxIou, 1, 1e-9);
}

TEST(ObjectEvaluation, PrefersTheSameLabelToTheNearerObject)
{
	const auto truth = graphOf({object(7, "cup", 0), object(8, "bowl", 0.3)});
	const auto result =
		evaluateObjects(graphOf({object(1, "bowl", 0.1), object(2, "cup", 0.2)}), truth);
	EXPECT_EQ(result.labelAccuracy, 1.0);
	EXPECT_NEAR(result.centreError.mean, 0.2, 1e-12);
}

TEST(ObjectEvaluation, FarCentresMatchWhenTheBoxesOverlap)
{
	// 0.6 m apart: boxes of 2 m share 1.4 of 2.6.
	const auto couch = boxed(object(1, "couch", 0.6), 2, 1, 1);
	const auto truth = boxed(object(1, "couch", 0), 2, 1, 1);
	EXPECT_NEAR(*evaluateObjects(graphOf({couch}), graphOf({truth})).meanBoxIou, 1.4 / 2.6, 1e-12);
	ObjectGate strict;
	strict.boxIou = 0.6;
	const auto result = evaluateObjects(graphOf({couch}), graphOf({truth}), {}, strict);
	EXPECT_TRUE(result.matches.empty());
}

TEST(ObjectEvaluation, ASecondObjectInARealOneIsADuplicate)
{
	const auto result = evaluateObjects(
		graphOf({object(1, "couch", 0), object(2, "couch", 0.9), object(3, "couch", 1.1)}),
		graphOf({boxed(object(7, "couch", 0), 2, 1, 1)}));
	EXPECT_EQ(result.matches.size(), 1u);
	EXPECT_EQ(result.duplicates, std::vector<ObjectId>{2});
	EXPECT_DOUBLE_EQ(*result.precision, 1.0 / 3);
}

TEST(ObjectEvaluation, DoesNotMissWhatWasNeverToBeSeen)
{
	auto seen = object(7, "cup", 0);
	seen.observations = 12;
	const auto result =
		evaluateObjects(graphOf({object(1, "cup", 0)}), graphOf({seen, object(8, "cup", 9)}));
	EXPECT_EQ(result.truth, 1u);
	EXPECT_EQ(result.recall, 1.0);
	const auto unknown = evaluateObjects(
		graphOf({object(1, "cup", 0)}), graphOf({object(7, "cup", 0), object(8, "cup", 9)}));
	EXPECT_EQ(unknown.recall, 0.5) << "no object tells observations: all count";
}

TEST(ObjectEvaluation, OfNothingIsEmptyAndNotANumber)
{
	const auto result = evaluateObjects({}, {});
	EXPECT_FALSE(result.precision);
	EXPECT_FALSE(result.recall);
	EXPECT_FALSE(result.labelAccuracy);
	EXPECT_EQ(evaluateObjects({}, graphOf({object(1, "cup", 0)})).recall, 0.0);
	EXPECT_EQ(evaluateObjects(graphOf({object(1, "cup", 0)}), {}).precision, 0.0);
}
}  // namespace
}  // namespace semloop
