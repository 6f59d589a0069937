#include <gtest/gtest.h>
#include <semloop/segmentation/YoloSegDecoder.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

constexpr int kLabels = 3;
constexpr int kPrototypes = 2;
const cv::Size kNetwork(64, 32);

/** Outputs of a network for 64 x 32 without detections. Prototype 0 is 1 in the left half and -1 in the
 *  right one, prototype 1 is 1 everywhere. */
struct FakeOutputs
{
	FakeOutputs()
	{
		const int predictionShape[] = {1, 4 + kLabels + kPrototypes, 32 + 8 + 2};
		outputs.predictions = cv::Mat(3, predictionShape, CV_32F, cv::Scalar(0));
		const int prototypeShape[] = {1, kPrototypes, 8, 16};
		outputs.prototypes = cv::Mat(4, prototypeShape, CV_32F, cv::Scalar(1));
		for (int y = 0; y < 8; y++)
			for (int x = 8; x < 16; x++) outputs.prototypes.ptr<float>(0, 0, y)[x] = -1;
	}

	void set(int column, const std::vector<float>& values)
	{
		for (std::size_t c = 0; c < values.size(); c++)
			outputs.predictions.at<float>(0, int(c), column) = values[c];
	}

	std::vector<Detection> decode(
		const DetectionLimits& limits = {}, cv::Size image = kNetwork) const
	{
		return decodeYoloSeg(outputs, Letterbox(image, kNetwork), limits);
	}

	YoloSegOutputs outputs;
};

TEST(YoloSegDecoder, RecognisesItsLayoutInEitherOrderOfOutputs)
{
	const FakeOutputs fake;
	const auto& o = fake.outputs;
	const auto found = findYoloSegOutputs({o.prototypes, o.predictions}, kNetwork);
	ASSERT_TRUE(found);
	EXPECT_EQ(found->labelCount(), kLabels);
	EXPECT_EQ(found->predictions.dims, 3);
	EXPECT_TRUE(findYoloSegOutputs({o.predictions, o.prototypes}, kNetwork));
}

TEST(YoloSegDecoder, RefusesOtherLayouts)
{
	const FakeOutputs fake;
	const auto& o = fake.outputs;
	EXPECT_FALSE(findYoloSegOutputs({}, kNetwork));
	EXPECT_FALSE(findYoloSegOutputs({o.predictions}, kNetwork));
	EXPECT_FALSE(findYoloSegOutputs({o.predictions, o.predictions}, kNetwork));
	EXPECT_FALSE(findYoloSegOutputs({o.predictions, o.prototypes}, {128, 64}));
	const int transposed[] = {1, 32 + 8 + 2, 4 + kLabels + kPrototypes};
	EXPECT_FALSE(findYoloSegOutputs({cv::Mat(3, transposed, CV_32F), o.prototypes}, kNetwork));
	const int noLabels[] = {1, 4 + kPrototypes, 32 + 8 + 2};
	EXPECT_FALSE(findYoloSegOutputs({cv::Mat(3, noLabels, CV_32F), o.prototypes}, kNetwork));
}

TEST(YoloSegDecoder, FindsNothingInZeros)
{
	EXPECT_TRUE(FakeOutputs().decode().empty());
}

TEST(YoloSegDecoder, BoxIsGivenByCentreAndSize)
{
	FakeOutputs fake;
	fake.set(7, {20, 10, 16, 8, 0, 0.8f, 0, 0, 1});
	const auto detections = fake.decode();
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].box, cv::Rect(12, 6, 16, 8));
	EXPECT_EQ(cv::countNonZero(detections[0].mask), 16 * 8);
}

TEST(YoloSegDecoder, MaskIsTheWeightedSumOfPrototypesInsideTheBox)
{
	FakeOutputs fake;
	fake.set(7, {32, 16, 40, 20, 0, 0.8f, 0, 1, 0});  // left half only
	const auto mask = fake.decode().at(0).mask;
	// Between the cells' centres at 30 and 34 the value crosses 0 at 32.
	EXPECT_EQ(cv::countNonZero(mask.colRange(0, 20)), 20 * 20);
	EXPECT_EQ(cv::countNonZero(mask.colRange(20, 40)), 0);
}

TEST(YoloSegDecoder, ScoresAreThoseOfTheKeptCandidateHighestFirst)
{
	FakeOutputs fake;
	fake.set(1, {20, 10, 16, 8, 0.3f, 0.8f, 0.01f, 0, 1});
	fake.set(2, {20, 10, 16, 8, 0.0f, 0.7f, 0.6f, 0, 1});
	DetectionLimits limits;
	limits.minLabelScore = 0.05;
	const auto detections = fake.decode(limits);
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].scores, LabelScores({{1, 0.8f}, {0, 0.3f}}));
}

TEST(YoloSegDecoder, DropsWhatScoresTooLow)
{
	FakeOutputs fake;
	fake.set(1, {20, 10, 16, 8, 0, 0.24f, 0, 0, 1});
	EXPECT_TRUE(fake.decode().empty());
	DetectionLimits limits;
	limits.minScore = 0.2;
	EXPECT_EQ(fake.decode(limits).size(), 1u);
}

TEST(YoloSegDecoder, ScalesBoxAndMaskToALargerImage)
{
	FakeOutputs fake;
	fake.set(7, {32, 16, 32, 16, 0, 0.8f, 0, 1, 0});
	// 128 x 32 goes in at half size with 8 rows of grey above and below.
	const auto detections = fake.decode({}, {128, 32});
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].box, cv::Rect(32, 0, 64, 32));
	EXPECT_EQ(cv::countNonZero(detections[0].mask.colRange(0, 32)), 32 * 32);
	EXPECT_EQ(cv::countNonZero(detections[0].mask.colRange(32, 64)), 0);
}

TEST(YoloSegDecoder, ClipsABoxThatLeavesTheImageAndDropsOneOutside)
{
	FakeOutputs fake;
	fake.set(1, {0, 0, 20, 20, 0, 0.8f, 0, 0, 1});
	fake.set(2, {100, 16, 20, 20, 0, 0.8f, 0, 0, 1});
	const auto detections = fake.decode();
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].box, cv::Rect(0, 0, 10, 10));
}

TEST(YoloSegDecoder, DropsCandidatesThatAreNotFinite)
{
	constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
	constexpr float kInfinity = std::numeric_limits<float>::infinity();
	FakeOutputs fake;
	fake.set(1, {kNan, 10, 20, 20, 0, 0.8f, 0, 0, 1});
	fake.set(2, {10, 10, kInfinity, 20, 0, 0.8f, 0, 0, 1});
	fake.set(3, {10, 10, 20, 20, 0, kNan, 0, 0, 1});
	fake.set(4, {10, 10, -20, 20, 0, 0.9f, 0, 0, 1});
	EXPECT_TRUE(fake.decode().empty());
}

}  // namespace
