#include <gtest/gtest.h>
#include <semloop/config/Error.h>

#include <algorithm>

#include "SimulatedFurniture.h"

using namespace semloop;

namespace
{
const std::vector<cv::Rect> kFour{
	{20, 30, 150, 200}, {200, 40, 120, 100}, {400, 10, 200, 150}, {100, 280, 300, 180}};
const Scene kFourChairs = sceneOf({kChair, kChair, kChair, kChair});
const Scene kTwentyChairs = sceneOf(std::vector<uint32_t>(20, kChair));

/** How many detections there are in all images with the seeds 0 to images - 1. */
int countDetections(
	const RenderedView& view, const Scene& scene, const SimulatedDetectorOptions& options,
	int images, const std::vector<float>& hidden = {})
{
	int count = 0;
	for (int seed = 0; seed < images; seed++)
		count +=
			int(detectInstances(view, hidden, scene, options, uint64_t(seed)).instances.size());
	return count;
}

/** Four standard deviations of a number of successes. */
double fourSigma(int trials, double p)
{
	return 4 * std::sqrt(trials * p * (1 - p));
}
}  // namespace

TEST(SimulatedDetector, TrueInstancesAreTheObjectsThatAreSeen)
{
	// The second object is covered by the third.
	const RenderedView view = viewOf({{10, 20, 30, 40}, {200, 200, 50, 50}, {190, 190, 70, 70}});
	const Scene scene = sceneOf({kChair, kCouch, kTable});
	const CObservationInstances truth = trueInstances(view, scene, {}, 1);
	ASSERT_EQ(truth.instances.size(), 2u);
	EXPECT_EQ(truth.labels, scene.labels);
	EXPECT_EQ(truth.imageSize(), cv::Size(640, 480));
	EXPECT_NO_THROW(truth.validate());
	EXPECT_EQ(truth.instances[0].trueObject, 1u);
	EXPECT_EQ(truth.instances[0].box, cv::Rect(10, 20, 30, 40));
	EXPECT_EQ(truth.instances[0].mask.area(), 1200u);
	EXPECT_EQ(truth.instances[1].trueObject, 3u);
	EXPECT_EQ(truth.instances[1].labelScores, (LabelScores{{kTable, 1.0F}}));
	EXPECT_EQ(truth.instances[1].confidence, 1);
}

TEST(SimulatedDetector, WithoutErrorsTheMasksAndLabelsAreTrue)
{
	const RenderedView view = viewOf(kFour);
	const Scene scene = sceneOf({kChair, kCouch, kTable, kChair});
	const auto truth = trueInstances(view, scene, {}, 1).instances;
	const auto found = detectInstances(view, {}, scene, withoutErrors(), 1).instances;
	ASSERT_EQ(found.size(), 4u);
	for (const auto& expected : truth)
	{
		const auto same = std::find_if(
			found.begin(), found.end(), [&](const Instance& i) { return i.mask == expected.mask; });
		ASSERT_NE(same, found.end()) << *expected.trueObject;
		EXPECT_EQ(same->label(), expected.label());
		EXPECT_FALSE(same->trueObject.has_value());
	}
}

TEST(SimulatedDetector, LargeOpenObjectsAreMissedAtTheRate)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.missRate = 0.2;
	const int found = countDetections(viewOf(twentyBoxes(100, 80)), kTwentyChairs, options, 100);
	EXPECT_NEAR(found, 1600, fourSigma(2000, 0.2));
}

TEST(SimulatedDetector, HalfAreMissedAtTheAreaAndATenthAtThrice)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.missArea = 400;
	const auto found = [&](int width, int height)
	{ return countDetections(viewOf(twentyBoxes(width, height)), kTwentyChairs, options, 100); };
	EXPECT_NEAR(found(20, 20), 1000, fourSigma(2000, 0.5));
	EXPECT_NEAR(found(30, 40), 1800, fourSigma(2000, 0.1));
}

TEST(SimulatedDetector, HalfAreMissedAtTheHiddenShareAndFewFarBelowIt)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.missHidden = 0.7;
	const RenderedView view = viewOf(twentyBoxes(100, 80));
	const auto found = [&](float hidden)
	{ return countDetections(view, kTwentyChairs, options, 50, std::vector<float>(21, hidden)); };
	EXPECT_NEAR(found(0.7F), 500, fourSigma(1000, 0.5));
	EXPECT_GE(found(0.3F), 985);  // 1 / (1 + e^(0.4 / 0.07)) = 0.3 % are missed
	EXPECT_LE(found(0.95F), 60);  // 1 / (1 + e^(0.25 / 0.07)) = 2.7 % are not
}

TEST(SimulatedDetector, WhatIsBelowTheMinimumAreaIsNotReported)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.minimumArea = 100;
	const Scene scene = sceneOf({kChair, kChair});
	const auto view = viewOf({{50, 50, 10, 10}, {100, 50, 11, 9}});
	const auto found = detectInstances(view, {}, scene, options, 1).instances;
	ASSERT_EQ(found.size(), 1u);
	EXPECT_EQ(found[0].box, cv::Rect(50, 50, 10, 10));
}

TEST(SimulatedDetector, AreasCountAsInAnImageOf640)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.minimumArea = 100;
	RenderedView view = wallView(320, 240, 3.0F);
	view.object(cv::Rect(50, 50, 5, 5)) = cv::Scalar(1);
	view.object(cv::Rect(80, 50, 6, 4)) = cv::Scalar(2);
	const auto found = detectInstances(view, {}, sceneOf({kChair, kChair}), options, 1).instances;
	ASSERT_EQ(found.size(), 1u);
	EXPECT_EQ(found[0].mask.area(), 25u);
}

TEST(SimulatedDetector, WrongLabelsLeadAtTheRate)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.confusionRate = 0.3;
	const RenderedView view = viewOf(twentyBoxes(40, 40));
	int couches = 0, tables = 0;
	for (uint64_t seed = 0; seed < 500; seed++)
		for (const auto& i :
			 detectInstances(viewOf(kFour), {}, kFourChairs, options, seed).instances)
		{
			couches += i.label() == kCouch;
			tables += i.label() == kTable;
			ASSERT_EQ(i.labelScores.size(), 2u);
			EXPECT_LE(i.labelScores[0].score + i.labelScores[1].score, 1);
			EXPECT_TRUE(i.label() == kChair || i.labelScores[1].label == kChair);
		}
	EXPECT_NEAR(couches, 300, fourSigma(2000, 0.15));
	EXPECT_NEAR(tables, 300, fourSigma(2000, 0.15));
}

TEST(SimulatedDetector, ListedConfusionsReplaceTheRate)
{
	SimulatedDetectorOptions options = withoutErrors();
	options.confusionRate = 1;
	options.confusions = {"chair>dining table:0.25"};
	const RenderedView view = viewOf(twentyBoxes(40, 40));
	int tables = 0;
	for (uint64_t seed = 0; seed < 500; seed++)
		for (const auto& i :
			 detectInstances(viewOf(kFour), {}, kFourChairs, options, seed).instances)
		{
			tables += i.label() == kTable;
			EXPECT_NE(i.label(), kCouch);
		}
	EXPECT_NEAR(tables, 500, fourSigma(2000, 0.25));
}

TEST(SimulatedDetector, ConfusionsThatCannotBeReadAreRejected)
{
	for (const std::vector<std::string>& list : std::vector<std::vector<std::string>>{
			 {"chair"},
			 {"chair>couch"},
			 {"chair>couch:"},
			 {"chair>couch:1.5"},
			 {"chair>couch:0.2x"},
			 {"chair>chair:0.2"},
			 {"chair>stool:0.2"},
			 {"chair>couch:0.6", "chair>dining table:0.6"}})
	{
		SimulatedDetectorOptions options;
		options.confusions = list;
		EXPECT_THROW(detectInstances(viewOf(kFour), {}, kFourChairs, options, 1), UsageError)
			<< list.back();
	}
}

TEST(SimulatedDetector, LargeObjectsAreReportedWithMoreConfidenceAndFirst)
{
	const RenderedView view = viewOf({{10, 10, 15, 15}, {100, 100, 300, 300}});
	SimulatedDetectorOptions options = withoutErrors();
	options.missArea = 400;
	const Scene scene = sceneOf({kChair, kChair});
	double small = 0, large = 0;
	int smallCount = 0, largeCount = 0;
	for (uint64_t seed = 0; seed < 60; seed++)
	{
		const auto found = detectInstances(view, {}, scene, options, seed).instances;
		EXPECT_TRUE(std::is_sorted(
			found.begin(), found.end(),
			[](const Instance& a, const Instance& b) { return a.confidence > b.confidence; }));
		for (const auto& i : found)
		{
			const bool isLarge = i.mask.area() > 1000;
			(isLarge ? large : small) += double(i.confidence);
			(isLarge ? largeCount : smallCount)++;
		}
	}
	EXPECT_GT(large / largeCount, small / smallCount + 0.2);
}

TEST(SimulatedDetector, TheSeedDecidesTheResult)
{
	const auto detect = [](uint64_t seed)
	{ return detectInstances(viewOf(kFour), {}, kFourChairs, withManyErrors(), seed).instances; };
	const auto first = detect(1), again = detect(1), other = detect(2);
	ASSERT_EQ(first.size(), again.size());
	for (std::size_t i = 0; i < first.size(); i++)
	{
		EXPECT_EQ(first[i].mask, again[i].mask);
		EXPECT_EQ(first[i].labelScores, again[i].labelScores);
		EXPECT_EQ(first[i].confidence, again[i].confidence);
		EXPECT_EQ(first[i].embedding, again[i].embedding);
	}
	EXPECT_FALSE(first.size() == other.size() && first[0].mask == other[0].mask);
}

TEST(SimulatedDetector, NothingIsFoundInAnEmptyView)
{
	SimulatedDetectorOptions options;
	options.falseRate = 0;
	EXPECT_TRUE(trueInstances({}, kFourChairs, {}, 1).instances.empty());
	EXPECT_TRUE(detectInstances({}, {}, kFourChairs, {}, 1).instances.empty());
	EXPECT_TRUE(detectInstances(viewOf({}), {}, kFourChairs, options, 1).instances.empty());
}

TEST(SimulatedDetector, ViewsThatDoNotFitTheSceneAreRejected)
{
	const RenderedView view = viewOf(kFour);
	EXPECT_THROW(trueInstances(view, sceneOf({kChair}), {}, 1), InputError);
	EXPECT_THROW(detectInstances(view, {}, sceneOf({kChair}), {}, 1), InputError);
	EXPECT_THROW(detectInstances(view, {0, 0, 0, 0}, kFourChairs, {}, 1), InputError);
	EXPECT_THROW(trueInstances(view, sceneOf({kChair, 3, kChair, kChair}), {}, 1), InputError);
	RenderedView cut = view;
	cut.camera.ncols = 320;
	EXPECT_THROW(trueInstances(cut, kFourChairs, {}, 1), InputError);
}
