#include <gtest/gtest.h>

#include <semloop/observations/CameraFrames.h>

#include <cmath>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
/** max(1 - L), from the documented likelihood q + (1 - q) max(1 - L) of one detection. */
double bestMatch(const CObjectMap& map, const View& view, uint32_t label, const CPose3D& robot)
{
	constexpr double q = 0.1;
	const auto observation = observationOf(view, {label}, CPose3D());
	return (std::exp(map.computeObservationLikelihood(observation, robot)) - q) / (1 - q);
}
}  // namespace

// A map that takes observations by itself has no confusion matrix but this one.
TEST(CObjectMapConfusion, ALabelIsRightWithEightyPercentAndElseAnyOtherOfTheSet)
{
	Scene scene;
	scene.spheres.push_back({{0, 0, 0.85}, 0.15, {40, 40, 220}, 1, 0});
	const CObjectMap map = mapOf(scene, {kCup});
	const View view = renderView(scene, testCamera(), onCircle(1, 8));
	const CPose3D robot = onCircle(1, 8) + (-robotFromCamera(CPose3D()));
	const double same = bestMatch(map, view, kCup, robot);
	EXPECT_GT(same, 0.7);
	EXPECT_LE(same, 0.8);
	// Three labels: 0.8, 0.1 and 0.1.
	EXPECT_NEAR(bestMatch(map, view, kBook, robot), same / 8, 1e-6);
	EXPECT_NEAR(bestMatch(map, view, kChair, robot), same / 8, 1e-6);
}
