#include <gtest/gtest.h>

#include "SimulatedFurniture.h"

using namespace semloop;

namespace
{
std::vector<Instance> detect(
	const RenderedView& view, const Scene& scene, const SimulatedDetectorOptions& options,
	uint64_t seed)
{
	return detectInstances(view, {}, scene, options, seed).instances;
}

/** First column of a row of the mask; -1: none. */
int firstColumn(const InstanceMask& mask, int row)
{
	for (const auto& run : mask.runs())
		if (run.row == row) return run.begin;
	return -1;
}
}  // namespace

TEST(SimulatedMasks, HoweverTheDetectorErrsTheResultIsValid)
{
	// Side by side, at the image's borders, and as large as the image's width.
	const RenderedView view = viewOf(
		{{0, 0, 100, 100},
		 {100, 0, 100, 100},
		 {200, 0, 440, 60},
		 {0, 100, 640, 100},
		 {600, 400, 40, 80}});
	const Scene scene = sceneOf({kChair, kChair, kTable, kCouch, kChair});
	for (uint64_t seed = 0; seed < 40; seed++)
	{
		const auto result = detectInstances(view, {}, scene, withManyErrors(), seed);
		ASSERT_NO_THROW(result.validate()) << seed;
		for (std::size_t i = 0; i < result.instances.size(); i++)
		{
			const Instance& a = result.instances[i];
			EXPECT_EQ(a.box, a.mask.boundingBox());
			EXPECT_GE(a.mask.area(), 100u);
			for (std::size_t j = 0; j < i; j++)
				ASSERT_EQ(intersectionArea(a.mask, result.instances[j].mask), 0u) << seed;
		}
	}
}

TEST(SimulatedMasks, TheEdgeHasItsSigmaAndBulges)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.boundaryNoise = 1.5;
	const RenderedView view = viewOf({{200, 100, 200, 300}});
	const Scene scene = sceneOf({kChair});
	double squares = 0, differences = 0, sum = 0;
	int count = 0;
	for (uint64_t seed = 0; seed < 200; seed++)
	{
		const auto found = detect(view, scene, options, seed);
		ASSERT_EQ(found.size(), 1u);
		for (int row = 130; row < 370; row += 10, count++)
		{
			const double here = firstColumn(found[0].mask, row) - 200;
			sum += here;
			squares += here * here;
			differences += std::pow(firstColumn(found[0].mask, row + 1) - 200 - here, 2);
		}
	}
	// 15 %: the distance field moves with the edge, a lattice is not even, pixels are whole.
	EXPECT_NEAR(std::sqrt(squares / count), 1.5, 0.15 * 1.5);
	EXPECT_NEAR(sum / count, 0, 0.15);
	EXPECT_LT(std::sqrt(differences / count), 0.5 * 1.5);  // independent rows: 1.4 * 1.5
}

TEST(SimulatedMasks, ASplitMaskIsTwoHalves)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.splitRate = 1;
	for (uint64_t seed = 0; seed < 20; seed++)
	{
		const auto found = detect(viewOf({{200, 100, 200, 200}}), sceneOf({kChair}), options, seed);
		ASSERT_EQ(found.size(), 2u);
		// A line through the middle halves a square.
		EXPECT_NEAR(double(found[0].mask.area()), 20000, 200);
		EXPECT_EQ(found[0].mask.area() + found[1].mask.area(), 40000u);
	}
}

TEST(SimulatedMasks, OnlyNeighboursOfOneLabelMerge)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.mergeRate = 1;
	const auto boxesOf =
		[&](const std::vector<cv::Rect>& boxes, const std::vector<uint32_t>& labels)
	{ return detect(viewOf(boxes), sceneOf(labels), options, 1).size(); };
	const cv::Rect left(100, 100, 50, 50), near(153, 100, 50, 50), far(160, 100, 50, 50);
	EXPECT_EQ(boxesOf({left, near}, {kChair, kChair}), 1u);
	EXPECT_EQ(boxesOf({left, near}, {kChair, kCouch}), 2u);
	EXPECT_EQ(boxesOf({left, far}, {kChair, kChair}), 2u);
	const auto merged = detect(viewOf({left, near}), sceneOf({kChair, kChair}), options, 1);
	EXPECT_EQ(merged[0].box, cv::Rect(100, 100, 103, 50));
	EXPECT_EQ(merged[0].mask.area(), 5000u);
}

TEST(SimulatedMasks, FalseDetectionsComeAtTheirRateWithLowScores)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.falseRate = 2;
	const Scene scene = sceneOf({});
	int count = 0, chairs = 0;
	for (uint64_t seed = 0; seed < 200; seed++)
		for (const auto& i : detect(viewOf({}), scene, options, seed))
		{
			count++;
			chairs += i.label() == kChair;
			EXPECT_LT(i.confidence, 0.61F);
		}
	EXPECT_NEAR(count, 400, 4 * std::sqrt(400.0));
	EXPECT_NEAR(chairs, count / 3.0, 4 * std::sqrt(count * 2 / 9.0));
}

TEST(SimulatedMasks, AFalseDetectionShowsOneThingThatIsNotReported)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.falseRate = 3;
	options.missRate = 0.5;
	const RenderedView view = viewOf({{0, 0, 320, 480}, {320, 0, 320, 240}});
	int onObjects = 0;
	for (uint64_t seed = 0; seed < 50; seed++)
		for (const auto& i : detect(view, sceneOf({kChair, kCouch}), options, seed))
		{
			if (i.mask.area() > 70000) continue;  // an object itself
			double least = 0, most = 0;
			cv::minMaxIdx(view.object, &least, &most, nullptr, nullptr, i.mask.decode());
			EXPECT_EQ(least, most);
			onObjects += most > 0;
		}
	EXPECT_GT(onObjects, 0);
}
