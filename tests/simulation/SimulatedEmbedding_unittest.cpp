#include "../../libs/simulation/src/SimulatedEmbedding.h"

#include <gtest/gtest.h>
#include <semloop/config/Error.h>

#include <numeric>

#include "SimulatedFurniture.h"

using namespace semloop;
using mrpt::poses::CPose3D;

namespace
{
constexpr double kDegree = 3.14159265358979323846 / 180;

/** Three metres from the origin, at its height. */
CPose3D cameraAt(double degrees)
{
	return CPose3D(3 * std::cos(degrees * kDegree), 3 * std::sin(degrees * kDegree), 0, 0, 0, 0);
}

double cosine(const std::vector<float>& a, const std::vector<float>& b)
{
	return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/** Mean similarity over 50 pairs of noise. */
template <typename Embed1, typename Embed2>
double similarity(const Embed1& first, const Embed2& second)
{
	double sum = 0;
	for (uint64_t i = 0; i < 50; i++) sum += cosine(first(2 * i), second(2 * i + 1));
	return sum / 50;
}

/** Of object `index` of the scene, by noise key. */
auto seen(const Scene& scene, std::size_t index, double degrees)
{
	return [&scene, index, degrees](uint64_t key)
	{ return simulatedEmbedding(scene, scene.objects[index], cameraAt(degrees), {}, key); };
}

const Scene kScene = sceneOf({kChair, kChair, kCouch});
}  // namespace

TEST(SimulatedEmbedding, IsOfUnitLengthAndOfTheSizeAskedFor)
{
	for (const int size : {8, 64, 512})
	{
		SimulatedDetectorOptions options;
		options.embeddingSize = size;
		const auto e = simulatedEmbedding(kScene, kScene.objects[0], cameraAt(10), options, 1);
		EXPECT_EQ(e.size(), std::size_t(size));
		EXPECT_NEAR(cosine(e, e), 1, 1e-6);
	}
	SimulatedDetectorOptions none;
	none.embeddingSize = 0;
	EXPECT_TRUE(simulatedEmbedding(kScene, kScene.objects[0], cameraAt(10), none, 1).empty());
}

// The formulas are in SimulatedEmbedding.h; 0.04 is for the noise's chance angle with the rest.

TEST(SimulatedEmbedding, ViewsFromNearbyAreAlikeThoseFromBehindLessSo)
{
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 0, 30)), 0.93, 0.04);
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 0, 50)), 0.91, 0.04);
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 0, 120)), 0.69, 0.04);
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 0, 210)), 0.61, 0.04);
}

TEST(SimulatedEmbedding, ObjectsOfOneLabelShareItsPartOthersNothing)
{
	// Random directions of 64 numbers have a cosine of 0 +- 1 / 8, times their share.
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 1, 30)), 0.3, 0.15);
	EXPECT_NEAR(similarity(seen(kScene, 0, 30), seen(kScene, 2, 30)), 0, 0.2);
}

TEST(SimulatedEmbedding, CopiesOfAModelLookMuchTheSameFromTheSameSide)
{
	Scene scene = sceneOf({kChair, kChair});
	scene.objects[1].model = scene.objects[0].model;
	// 0.93 - 0.3 * 0.43
	EXPECT_NEAR(similarity(seen(scene, 0, 30), seen(scene, 1, 30)), 0.80, 0.04);
}

TEST(SimulatedEmbedding, TurnsWithTheObject)
{
	Scene scene = sceneOf({kChair});
	const auto before = seen(scene, 0, 30)(1);
	scene.objects[0].T_world_object = CPose3D(0, 0, 0, 40 * kDegree, 0, 0);
	const auto after = seen(scene, 0, 70)(1);
	EXPECT_NEAR(cosine(before, after), 1, 1e-6);
}

TEST(SimulatedEmbedding, AMergedOneIsLikeBoth)
{
	const auto a = seen(kScene, 0, 30)(1), b = seen(kScene, 1, 30)(2);
	const auto merged = mergedEmbedding(a, b);
	EXPECT_NEAR(cosine(merged, merged), 1, 1e-6);
	// The bisector of two unit vectors: sqrt((1 + cos) / 2).
	EXPECT_NEAR(cosine(merged, a), std::sqrt((1 + cosine(a, b)) / 2), 1e-6);
	EXPECT_NEAR(cosine(merged, a), cosine(merged, b), 1e-6);
}

TEST(SimulatedEmbedding, AFalseOneHasOnlyTheLabelInCommon)
{
	const auto phantom = falseEmbedding("chair", {}, 99);
	EXPECT_NEAR(cosine(phantom, phantom), 1, 1e-6);
	EXPECT_NEAR(cosine(phantom, seen(kScene, 0, 30)(1)), 0.3, 0.25);
}

TEST(SimulatedEmbedding, SharesAboveOneAndTooFewNumbersAreRejected)
{
	SimulatedDetectorOptions options;
	options.embeddingClass = 0.8;
	EXPECT_THROW(simulatedEmbedding(kScene, kScene.objects[0], {}, options, 1), UsageError);
	options = {};
	options.embeddingSize = 7;
	EXPECT_THROW(simulatedEmbedding(kScene, kScene.objects[0], {}, options, 1), UsageError);
}
