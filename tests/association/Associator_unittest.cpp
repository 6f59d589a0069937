#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/association/NearestNeighbourAssociator.h>
#include <semloop/association/ObjectAssociator.h>
#include <semloop/config/Error.h>

#include <cmath>
#include <memory>

using namespace semloop;

namespace
{
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
using Items = std::vector<AssociationItem>;

const LabelScores kChair{{0, 0.9f}, {1, 0.1f}};
const LabelScores kTable{{1, 1}};

AssociationItem at(double x, const LabelScores& labelScores = kChair)
{
	AssociationItem item;
	item.labelScores = &labelScores;
	item.surface = SurfaceExtent{{x, 0, 2}, 0.1};
	return item;
}

/** The difference of the centres: costs that a reader can see. */
class CentreCost : public MatchingCost
{
public:
	void configure(const mrpt::config::CConfigFileBase&, const std::string&) override {}
	void setConfusionMatrix(ConfusionMatrix) override {}
	double cost(const AssociationItem& landmark, const AssociationItem& detection) const override
	{
		return std::abs(landmark.surface->centre.x - detection.surface->centre.x);
	}
	mrpt::rtti::CObject* clone() const override { return new CentreCost(*this); }
};

ObjectAssociator objectAssociator(double gate)
{
	ObjectAssociator associator;
	associator.options.gate = gate;
	associator.setMatchingCost(std::make_shared<CentreCost>());
	return associator;
}
}  // namespace

TEST(ObjectAssociator, FindsTheCheapestWholeWhereTheNearestNeighbourIsGreedy)
{
	// Drift has moved both detections 0.3 to the right: the first is nearest to its neighbour.
	const Items landmarks{at(0), at(0.5)}, detections{at(0.3), at(0.8)};
	EXPECT_EQ(
		objectAssociator(1).associate(landmarks, detections).matches, (Pairs{{0, 0}, {1, 1}}));
	NearestNeighbourAssociator baseline;
	baseline.options.maxCentreDistance = 1;
	EXPECT_EQ(baseline.associate(landmarks, detections).matches, (Pairs{{0, 1}, {1, 0}}));
}

TEST(ObjectAssociator, LeavesADetectionUnmatchedWhenEveryLandmarkCostsMoreThanTheGate)
{
	const auto result = objectAssociator(0.2).associate({at(0), at(1)}, {at(0.5), at(1.1)});
	EXPECT_EQ(result.matches, (Pairs{{1, 1}}));
	EXPECT_NEAR(result.cost, 0.1, 1e-12);
}

TEST(ObjectAssociator, OfNothingIsEmpty)
{
	EXPECT_TRUE(objectAssociator(1).associate({}, {at(0)}).matches.empty());
	EXPECT_TRUE(objectAssociator(1).associate({at(0)}, {}).matches.empty());
}

TEST(ObjectAssociator, NeedsACost)
{
	EXPECT_THROW(ObjectAssociator().associate({at(0)}, {at(0)}), UsageError);
}

TEST(NearestNeighbourAssociator, TakesTheNearestOfTheSameLabel)
{
	NearestNeighbourAssociator associator;
	associator.options.maxCentreDistance = 1;
	const auto result =
		associator.associate({at(0.1, kTable), at(0.3), at(-0.4)}, {at(0), at(0, kTable)});
	EXPECT_EQ(result.matches, (Pairs{{0, 1}, {1, 0}}));
	EXPECT_NEAR(result.cost, 0.4, 1e-12);
}

TEST(NearestNeighbourAssociator, DoesNotReachBeyondItsGate)
{
	NearestNeighbourAssociator associator;
	associator.options.maxCentreDistance = 0.2;
	EXPECT_TRUE(associator.associate({at(0.25)}, {at(0)}).matches.empty());
	EXPECT_EQ(associator.associate({at(0.15)}, {at(0)}).matches, (Pairs{{0, 0}}));
}

TEST(NearestNeighbourAssociator, GivesALandmarkToTheFirstDetectionThatWantsIt)
{
	const NearestNeighbourAssociator associator;
	EXPECT_EQ(associator.associate({at(0)}, {at(0.2), at(0.1)}).matches, (Pairs{{0, 0}}));
}

TEST(NearestNeighbourAssociator, PassesOverItemsWithoutACentreOrALabel)
{
	const NearestNeighbourAssociator associator;
	const LabelScores none;
	auto unknown = at(0);
	unknown.surface.reset();
	EXPECT_TRUE(associator.associate({unknown}, {at(0)}).matches.empty());
	EXPECT_TRUE(associator.associate({at(0)}, {unknown}).matches.empty());
	EXPECT_TRUE(associator.associate({at(0, none)}, {at(0, none)}).matches.empty());
	EXPECT_TRUE(associator.associate({}, {at(0)}).matches.empty());
}

TEST(Associators, AreMadeByNameAndConfiguredFromTheirSections)
{
	mrpt::config::CConfigFileMemory config(
		"[object]\ngate = 0.6\n[nearest]\nmax_centre_distance = 0.3\n");
	const auto object = std::dynamic_pointer_cast<ObjectAssociator>(
		mrpt::rtti::classFactory("semloop::ObjectAssociator"));
	ASSERT_TRUE(object);
	object->configure(config, "object");
	EXPECT_EQ(object->options.gate, 0.6);
	const auto nearest = std::dynamic_pointer_cast<NearestNeighbourAssociator>(
		mrpt::rtti::classFactory("semloop::NearestNeighbourAssociator"));
	ASSERT_TRUE(nearest);
	nearest->configure(config, "nearest");
	EXPECT_EQ(nearest->options.maxCentreDistance, 0.3);
	EXPECT_THROW(object->configure(config, "nearest"), UsageError);
}
