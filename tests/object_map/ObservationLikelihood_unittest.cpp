#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/ObservationLikelihood.h>
#include <semloop/observations/CameraFrames.h>

#include <cmath>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
constexpr double q = 0.1, p = 0.8,
				 s = 0.2;  // the defaults; the confusion matrix is right with 80 %

/** One detection that agrees with one object by this much. */
double logOf(double agreement)
{
	return std::log(q + (1 - q) * p * agreement);
}

/** A ball of 0.3 m, mapped as a cup, and what a camera saw of it from one side. */
class ObservationLikelihoodOfBall : public testing::Test
{
protected:
	ObservationLikelihoodOfBall()
	{
		scene_.spheres.push_back({{0, 0, 0.85}, 0.15, {40, 40, 220}, 1, 0});
		map_ = mapOf(scene_, {kCup});
		observation_ =
			observationOf(renderView(scene_, testCamera(), onCircle(1, 8)), {kCup}, CPose3D());
	}
	double log(const CPose3D& robot) const
	{
		return ObservationLikelihood(map_, observation_, {}).log(robot);
	}
	/** The true pose, moved in the world. */
	CPose3D moved(double x, double y, double z) const { return CPose3D(x, y, z, 0, 0, 0) + truth_; }

	Scene scene_;
	CObjectMap map_;
	CObservationInstances observation_;
	const CPose3D truth_ = onCircle(1, 8) + (-robotFromCamera(CPose3D()));
};

TEST_F(ObservationLikelihoodOfBall, AtTheTruthTheDetectionLiesInItsObject)
{
	EXPECT_NEAR(log(truth_), logOf(1), 0.01);
}

TEST_F(ObservationLikelihoodOfBall, FallsWithTheMeanDistanceFromTheObject)
{
	// Ten metres up, the ball's points are 10 m - 0.15 m + (0 to 0.3 m) above its box.
	const double far = log(moved(0, 0, 10));
	EXPECT_GT(far, logOf(1 / (1 + std::pow(10.0 / s, 2))) - 1e-9);
	EXPECT_LT(far, logOf(1 / (1 + std::pow(9.7 / s, 2))) + 1e-9);
	double before = log(truth_);
	for (const double shift : {0.1, 0.2, 0.4, 0.8, 1.6})
	{
		const double now = log(moved(shift, 0, 0));
		EXPECT_LT(now, before) << shift;
		before = now;
	}
}

TEST_F(ObservationLikelihoodOfBall, TwoDetectionsAreNotOneObject)
{
	observation_.instances.push_back(observation_.instances.front());
	EXPECT_NEAR(log(truth_), logOf(1) + std::log(q), 0.01);
}

TEST_F(ObservationLikelihoodOfBall, EmbeddingsWeighTheAgreement)
{
	observation_.instances.front().embedding = {0.6f, 0.8f};
	EXPECT_NEAR(log(truth_), logOf(1), 0.01);  // the map's has none
	CObjectMap map = emptyMap();
	View view = renderView(scene_, testCamera(), onCircle(1, 8));
	map.addObject(
		view.frame, makeInstance(view.masks[1], kCup, 1.0f, {1.0f, 0.0f}), onCircle(1, 8));
	EXPECT_NEAR(ObservationLikelihood(map, observation_, {}).log(truth_), logOf(0.6), 0.02);
}

TEST_F(ObservationLikelihoodOfBall, WithoutDepthTheBoxesInTheImageAreCompared)
{
	observation_.instances.front().depth.reset();
	// The image of a ball's box is larger than the ball's: pi / 4 of a square, seen straight on.
	const double best = log(truth_);
	EXPECT_GT(best, logOf(0.5));
	EXPECT_LT(best, logOf(1));
	EXPECT_LT(log(moved(0.3, 0, 0)), best);
	EXPECT_LT(log(moved(0, 0.3, 0)), best);
	EXPECT_NEAR(log(truth_ + CPose3D(0, 0, 0, M_PI, 0, 0)), std::log(q), 1e-9);
}

TEST_F(ObservationLikelihoodOfBall, NothingSeenSaysNothingAndAnEmptyMapExplainsNothing)
{
	const CObjectMap empty = emptyMap();
	EXPECT_NEAR(ObservationLikelihood(empty, observation_, {}).log(truth_), std::log(q), 1e-9);
	observation_.instances.clear();
	EXPECT_EQ(log(truth_), 0);
}

TEST_F(ObservationLikelihoodOfBall, OtherLabelsAreAnError)
{
	observation_.labels = LabelSet::coco();
	EXPECT_THROW(log(truth_), InputError);
}

TEST_F(ObservationLikelihoodOfBall, TheMapsCacheFollowsMapObservationAndOptions)
{
	const double before = map_.computeObservationLikelihood(observation_, truth_);
	EXPECT_NEAR(before, log(truth_), 1e-12);
	CObjectMap copy = map_;
	map_.moveObjects({{0, CPose3D(0, 0, 5, 0, 0, 0)}});
	EXPECT_LT(map_.computeObservationLikelihood(observation_, truth_), before - 1);
	EXPECT_EQ(copy.computeObservationLikelihood(observation_, truth_), before);
	observation_.instances.front().labelScores = {{kBook, 1.0f}};
	EXPECT_LT(copy.computeObservationLikelihood(observation_, truth_), before - 0.5);
	const double asBook = copy.computeObservationLikelihood(observation_, truth_);
	CObservationInstances closer = observation_;
	closer.camera.fx(closer.camera.fx() * 1.5);
	closer.camera.fy(closer.camera.fy() * 1.5);
	EXPECT_NE(copy.computeObservationLikelihood(closer, truth_), asBook);
	EXPECT_EQ(copy.computeObservationLikelihood(observation_, truth_), asBook);
	observation_.camera = closer.camera;
	EXPECT_NE(copy.computeObservationLikelihood(observation_, truth_), asBook);
	copy.likelihoodOptions.unexplained = 0.5;
	EXPECT_NEAR(
		copy.computeObservationLikelihood(observation_, truth_), std::log(0.5 + 0.5 * 0.1), 0.01);
}

}  // namespace
