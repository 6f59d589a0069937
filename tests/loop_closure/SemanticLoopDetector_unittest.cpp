#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/loop_closure/SemanticLoopDetector.h>

#include <cmath>

#include "GraphFixtures.h"
#include "SyntheticScene.h"

namespace
{
using namespace semloop;
using namespace semloop::fixtures;
using testing::HasSubstr;
using Decision = LoopVerdict::Decision;

const std::string kSection = "loop_detection";

TEST(SemanticLoopDetector, ReadsTheSectionsOfAllItsParts)
{
	mrpt::config::CConfigFileMemory config;
	config.write(kSection, "matcher", std::string("spectral-verified"));
	config.write(kSection, "max_vertical_error", 0.125);
	config.write(kSection, "min_matches", 7);
	config.write(kSection, "rival_distance", 0.5);
	config.write("graph_matching", "mu", 3.0);
	config.write("alignment", "min_fitness", 0.125);
	SemanticLoopDetector detector;
	detector.configure(config, kSection);
	EXPECT_EQ(detector.options().maxVerticalError, 0.125);
	EXPECT_EQ(detector.options().recognition.minMatches, 7);
	EXPECT_EQ(detector.options().recognition.search.rivalDistance, 0.5);
	EXPECT_EQ(detector.aligner.options.minFitness, 0.125);

	config.write(kSection, "min_sigma", 2.0);
	EXPECT_THROW(detector.configure(config, kSection), UsageError);
	config.write(kSection, "min_sigma", 0.03);
	config.write("graph_matching", "nu", 3.0);
	EXPECT_THROW(detector.configure(config, kSection), UsageError);
}

TEST(SemanticLoopDetector, AnUnregisteredMatcherIsAnErrorThatListsTheRegisteredOnes)
{
	for (const std::string name : {"semloop::Guess", "semloop::SemanticLoopDetector"})
	{
		mrpt::config::CConfigFileMemory config;
		config.write(kSection, "matcher", name);
		SemanticLoopDetector detector;
		try
		{
			detector.configure(config, kSection);
			FAIL() << name;
		}
		catch (const UsageError& error)
		{
			EXPECT_THAT(error.what(), HasSubstr("[loop_detection] matcher = " + name));
			EXPECT_THAT(error.what(), HasSubstr("semloop::SpectralMatcher"));
			EXPECT_THAT(error.what(), HasSubstr("pairwise"));
		}
	}
}

TEST(LoopVerdict, DecisionsHaveNames)
{
	EXPECT_STREQ(toString(Decision::Accepted), "accepted");
	EXPECT_STREQ(toString(Decision::Rejected), "rejected");
	EXPECT_STREQ(toString(Decision::Ambiguous), "ambiguous");
}

/** Five objects, mapped once where they stand and once more, later, by a drifted camera. */
class SemanticLoopDetectorOnAMap : public testing::Test
{
protected:
	static constexpr int kObjects = 5;

	void SetUp() override
	{
		map.setLabels(LabelSet({"a", "b", "c", "d", "e"}));
		target = mapScene(CPose3D());
		query = mapScene(drift);
	}

	using CPose3D = mrpt::poses::CPose3D;

	/** Ids of the scene's objects, added to the map by cameras that believe to be at wrong * truth;
	 *  the last object stands lastMoved further in x. */
	std::set<ObjectId> mapScene(const CPose3D& wrong, double lastMoved = 0)
	{
		using namespace semloop::synthetic;
		Scene scene;
		const double places[kObjects][2] = {
			{0, -0.7}, {0.3, -0.2}, {-0.4, 0.1}, {0.2, 0.5}, {-0.1, 0.9}};
		for (int i = 0; i < kObjects; ++i)
			scene.boxes.push_back(
				{CPose3D(
					 places[i][0] + (i + 1 == kObjects ? lastMoved : 0), places[i][1],
					 0.8 + 0.05 * i, 0.4 * i, 0, 0),
				 {0.2 + 0.02 * i, 0.15, 0.15 + 0.05 * i},
				 {200, 0, 0},
				 i + 1,
				 0});
		std::set<ObjectId> ids;
		std::vector<ObjectId> idOf(kObjects);
		for (int view = 0; view < 3; ++view)
		{
			const auto T_world_camera = lookAt({1.6, 0.5 * view - 0.5, 1.6}, {0, 0.1, 0.8});
			const auto image = renderView(scene, makeCamera(320, 240, 200), T_world_camera);
			for (int i = 0; i < kObjects; ++i)
			{
				const auto instance = makeInstance(image.masks[i + 1], i);
				const auto believed = wrong + T_world_camera;
				if (view == 0)
					ids.insert(idOf[i] = map.addObject(image.frame, instance, believed).value());
				else
					map.fuse(idOf[i], image.frame, instance, believed);
			}
		}
		map.markCovisible(ids);
		return ids;
	}

	/** For objects seen in three frames. */
	static SemanticLoopDetector makeDetector(int minObservations = 3)
	{
		SemanticLoopDetectorOptions options;
		options.minObservations = minObservations;
		return SemanticLoopDetector(options);
	}

	const CPose3D drift = yawPose(0.5, -0.3, 0.05, 0.12);
	CObjectMap map;
	std::set<ObjectId> target, query;
};

TEST_F(SemanticLoopDetectorOnAMap, CorrectsTheDriftToAFractionOfAVoxel)
{
	const auto verdict = makeDetector().detect({map, query, target});
	ASSERT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_EQ(verdict.matches.size(), kObjects);
	const auto corrected = verdict.T_target_query + drift;
	EXPECT_LT(corrected.translation().norm(), 0.01);
	EXPECT_LT(rotationAngle(corrected), 0.01);
	EXPECT_GT(verdict.alignmentFitness.value(), 0.8);
	EXPECT_LT(verdict.alignmentRmse.value(), 0.01);
	EXPECT_THAT(verdict.reason, HasSubstr("surface points align"));

	ASSERT_EQ(verdict.alignments.size(), kObjects);
	for (const auto& alignment : verdict.alignments)
	{
		EXPECT_LT((alignment.T_target_query + drift).translation().norm(), 0.03);
		// At least as certain as the centre alone.
		EXPECT_GE(alignment.information(0, 0), 1 / 0.09);
	}
}

TEST_F(SemanticLoopDetectorOnAMap, AnObjectThatTheSurfacesOfTheOthersRefuteIsNoMatch)
{
	// A pose of the centres spreads the 0.45 m over all, within the gates; the other four surfaces fit exactly.
	const auto moved = mapScene(drift, 0.45);
	const auto verdict = makeDetector().detect({map, moved, target});
	ASSERT_EQ(verdict.decision, Decision::Accepted) << verdict.reason;
	EXPECT_EQ(verdict.candidates.size(), kObjects);
	ASSERT_EQ(verdict.matches.size(), kObjects - 1U);
	EXPECT_EQ(verdict.alignments.size(), kObjects - 1U);
	for (const auto& match : verdict.matches) EXPECT_NE(match.first, *moved.rbegin());
	EXPECT_LT((verdict.T_target_query + drift).translation().norm(), 0.02);
}

TEST_F(SemanticLoopDetectorOnAMap, APriorThatRulesTheCorrectionOutIsBelieved)
{
	EXPECT_EQ(
		makeDetector().detect({map, query, target, PosePrior{}}).decision, Decision::Accepted);
	PosePrior prior;
	prior.sigmaXY = prior.sigmaZ = prior.sigmaYaw = 0.08;
	const auto verdict = makeDetector().detect({map, query, target, prior});
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_THAT(verdict.reason, HasSubstr("standard deviations from the prior"));
}

TEST_F(SemanticLoopDetectorOnAMap, RejectsWhenTheSurfacesDoNotAlign)
{
	SemanticLoopDetector detector = makeDetector();
	detector.aligner.options.maxRmse = 1e-4;
	const auto verdict = detector.detect({map, query, target});
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_THAT(verdict.reason, HasSubstr("; but surfaces align to"));
}

TEST_F(SemanticLoopDetectorOnAMap, LeavesOutObjectsThatWereSeenTooSeldom)
{
	EXPECT_EQ(
		makeDetector(4).detect({map, query, target}).reason,
		"0 objects against 0: a place needs two on either side");
}

TEST_F(SemanticLoopDetectorOnAMap, AMatcherThatCannotTakeTheGraphIsARejection)
{
	mrpt::config::CConfigFileMemory config;
	config.write("graph_matching", "max_entries", 1);
	config.write(kSection, "matcher", std::string("spectral-verified"));
	config.write(kSection, "min_observations", 3);
	SemanticLoopDetector detector;
	detector.configure(config, kSection);
	const auto verdict = detector.detect({map, query, target});
	EXPECT_EQ(verdict.decision, Decision::Rejected);
	EXPECT_EQ(verdict.queryObjects, kObjects);
	EXPECT_THAT(verdict.reason, HasSubstr("max_entries"));
}
}  // namespace
