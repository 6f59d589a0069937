#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/association/MatchingCost.h>
#include <semloop/config/Error.h>

#include <cmath>
#include <memory>

using namespace semloop;

namespace
{
const cv::Size kImage(40, 30);
using Embeddings = std::vector<std::vector<float>>;

InstanceMask box(int x, int y, int width, int height, cv::Size image = kImage)
{
	return InstanceMask::encode(cv::Mat(height, width, CV_8UC1, cv::Scalar(255)), {x, y}, image);
}

/** An item with the data that it points to. */
struct Thing
{
	InstanceMask mask;
	LabelScores labelScores{{0, 1}};
	Embeddings embeddings;
	std::optional<SurfaceExtent> surface;

	AssociationItem item() const { return {&mask, &labelScores, &embeddings, surface}; }
};

SemanticMatchingCost perfectNetwork()
{
	SemanticMatchingCost cost;
	cost.setConfusionMatrix(ConfusionMatrix(LabelSet({"chair", "couch"}), 1.0));
	return cost;
}

double costOf(const SemanticMatchingCost& cost, const Thing& landmark, const Thing& detection)
{
	return cost.cost(landmark.item(), detection.item());
}
}  // namespace

TEST(SemanticMatchingCost, WithoutEmbeddingsIsOneMinusTheIouByTheCorrectedFormula)
{
	// Two 4 x 2 boxes share 2 x 2: IoU = 4 / (8 + 8 - 4). The misprint's 4 / (2 |m_k| - 4) differs
	// when the areas do: 4 x 2 and 2 x 2 inside it give 4 / 8, not 4 / 4.
	Thing a, b, inner;
	a.mask = box(0, 0, 4, 2);
	b.mask = box(2, 0, 4, 2);
	inner.mask = box(1, 0, 2, 2);
	const auto cost = perfectNetwork();
	EXPECT_NEAR(costOf(cost, a, b), 1 - 4.0 / 12, 1e-12);
	EXPECT_NEAR(costOf(cost, a, inner), 0.5, 1e-12);
	EXPECT_NEAR(costOf(cost, a, a), 0, 1e-12);
}

TEST(SemanticMatchingCost, WeighsIouAndTheBestEmbeddingByLambda)
{
	Thing landmark, detection;
	landmark.mask = box(0, 0, 4, 2);
	detection.mask = box(2, 0, 4, 2);
	landmark.embeddings = {{1, 0}, {0.6f, 0.8f}};
	detection.embeddings = {{0, 1}};
	auto cost = perfectNetwork();
	cost.options.lambda = 0.25;
	EXPECT_NEAR(costOf(cost, landmark, detection), 1 - (0.25 / 3 + 0.75 * 0.8), 1e-6);
}

TEST(SemanticMatchingCost, CountsOppositeEmbeddingsAsUnlikeAndNotAsWorse)
{
	Thing landmark, detection;
	landmark.mask = detection.mask = box(0, 0, 4, 2);
	landmark.embeddings = {{1, 0}};
	detection.embeddings = {{-1, 0}};
	EXPECT_NEAR(costOf(perfectNetwork(), landmark, detection), 1 - 0.5, 1e-6);
}

TEST(SemanticMatchingCost, UsesTheIouAloneWhenOneSideHasNoEmbedding)
{
	Thing landmark, detection;
	landmark.mask = detection.mask = box(0, 0, 4, 2);
	landmark.embeddings = {{1, 0}};
	EXPECT_NEAR(costOf(perfectNetwork(), landmark, detection), 0, 1e-12);
	detection.embeddings = {{}};
	EXPECT_NEAR(costOf(perfectNetwork(), landmark, detection), 0, 1e-12);
	auto item = detection.item();
	item.embeddings = nullptr;
	EXPECT_NEAR(perfectNetwork().cost(landmark.item(), item), 0, 1e-12);
}

TEST(SemanticMatchingCost, AsksHowProbablyTheTrueLabelIsCalledTheObservedOne)
{
	SemanticMatchingCost cost;
	// A true chair is often called couch (11 of 21), a true couch never a chair (1 of 11).
	cost.setConfusionMatrix(ConfusionMatrix::learn(
		LabelSet({"chair", "couch"}), std::vector<std::pair<uint32_t, uint32_t>>(10, {0, 1}), 1));
	Thing chair, couch;
	chair.mask = couch.mask = box(0, 0, 4, 2);
	couch.labelScores = {{1, 1}};
	EXPECT_NEAR(costOf(cost, chair, couch), 1 - 11.0 / 21, 1e-6);
	EXPECT_NEAR(costOf(cost, couch, chair), 1 - 1.0 / 11, 1e-6);
}

TEST(SemanticMatchingCost, DoesNotTakeAWeakScoreForADisagreement)
{
	Thing sure, weak;
	sure.mask = weak.mask = box(0, 0, 4, 2);
	weak.labelScores = {{0, 0.45f}};
	EXPECT_NEAR(costOf(perfectNetwork(), sure, weak), 0, 1e-6);
	weak.labelScores = {{0, 0.3f}, {1, 0.1f}};
	EXPECT_NEAR(costOf(perfectNetwork(), sure, weak), 0.25, 1e-6);
}

TEST(SemanticMatchingCost, IsOneForLabelsThatAreNeverConfused)
{
	Thing chair, couch;
	chair.mask = couch.mask = box(0, 0, 4, 2);
	couch.labelScores = {{1, 1}};
	EXPECT_EQ(costOf(perfectNetwork(), chair, couch), 1);
	couch.labelScores = {};
	EXPECT_EQ(costOf(perfectNetwork(), chair, couch), 1);
}

TEST(SemanticMatchingCost, ForbidsCentresThatAreTooFarApart)
{
	Thing a, b;
	a.mask = b.mask = box(0, 0, 4, 2);
	a.surface = SurfaceExtent{{0, 0, 2}, 0.1};
	b.surface = SurfaceExtent{{0.3, 0.4, 2}, 0.1};
	auto cost = perfectNetwork();
	cost.options.maxCentreDistance = 0.51;
	EXPECT_NEAR(costOf(cost, a, b), 0, 1e-12);
	cost.options.maxCentreDistance = 0.49;
	EXPECT_TRUE(std::isinf(costOf(cost, a, b)));
	b.surface.reset();
	EXPECT_NEAR(costOf(cost, a, b), 0, 1e-12);
}

TEST(SemanticMatchingCost, TreatsALandmarkOutOfThePictureAsNotOverlapping)
{
	Thing landmark, detection;
	landmark.embeddings = detection.embeddings = {{1, 0}};
	detection.mask = box(0, 0, 4, 2);
	auto item = landmark.item();
	item.mask = nullptr;
	EXPECT_NEAR(perfectNetwork().cost(item, detection.item()), 0.5, 1e-6);
	landmark.mask = InstanceMask(kImage);
	EXPECT_NEAR(costOf(perfectNetwork(), landmark, detection), 0.5, 1e-6);
}

TEST(SemanticMatchingCost, RefusesDataThatCannotBeCompared)
{
	Thing a, b;
	a.mask = box(0, 0, 4, 2);
	b.mask = box(20, 20, 4, 2, {80, 60});
	EXPECT_THROW(costOf(perfectNetwork(), a, b), InputError);
	b.mask = a.mask;
	a.embeddings = {{1, 0}};
	b.embeddings = {{1, 0, 0}};
	EXPECT_THROW(costOf(perfectNetwork(), a, b), InputError);
	EXPECT_THROW(SemanticMatchingCost().cost(a.item(), a.item()), UsageError);
}

TEST(SemanticMatchingCost, IsMadeByNameAndConfiguredFromItsSection)
{
	const auto object = mrpt::rtti::classFactory("semloop::SemanticMatchingCost");
	const auto cost = std::dynamic_pointer_cast<SemanticMatchingCost>(object);
	ASSERT_TRUE(cost);
	mrpt::config::CConfigFileMemory config("[cost]\nlambda = 0.7\nmax_centre_distance = 1.5\n");
	cost->configure(config, "cost");
	EXPECT_EQ(cost->options.lambda, 0.7);
	EXPECT_EQ(cost->options.maxCentreDistance, 1.5);
	EXPECT_THROW(
		cost->configure(mrpt::config::CConfigFileMemory("[cost]\nlambda = 1.1\n"), "cost"),
		UsageError);
}

TEST(EmbeddingSimilarity, IsTheLargestDotProductOfAllPairs)
{
	EXPECT_NEAR(*embeddingSimilarity({{1, 0}, {0, 1}}, {{0.6f, 0.8f}}), 0.8, 1e-6);
	EXPECT_NEAR(*embeddingSimilarity({{1, 0}}, {{-1, 0}}), -1, 1e-6);
	EXPECT_FALSE(embeddingSimilarity({}, {{1, 0}}));
	EXPECT_FALSE(embeddingSimilarity({{1, 0}}, {}));
}
