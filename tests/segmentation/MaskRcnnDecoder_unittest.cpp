#include <gtest/gtest.h>
#include <semloop/observations/LabelSet.h>
#include <semloop/segmentation/MaskRcnnDecoder.h>

#include <limits>
#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

constexpr int kLabels = 3;
const cv::Size kNetwork(100, 80);

/** Two boxes; every mask is 0.9 in the upper half of its box and 0.1 in the lower one. */
struct FakeOutputs
{
	FakeOutputs()
	{
		const int boxShape[] = {1, 1, 2, 7};
		outputs.boxes = cv::Mat(4, boxShape, CV_32F, cv::Scalar(0));
		const int maskShape[] = {2, kLabels, 4, 4};
		outputs.masks = cv::Mat(4, maskShape, CV_32F, cv::Scalar(0.9));
		for (int i = 0; i < 2; i++)
			for (int label = 0; label < kLabels; label++)
				for (int y = 2; y < 4; y++)
					for (int x = 0; x < 4; x++) *mask(i, label, y, x) = 0.1f;
	}

	float* mask(int i, int label, int y, int x)
	{
		const int place[] = {i, label, y, x};
		return outputs.masks.ptr<float>(place);
	}

	void set(int row, float label, float score, float left, float top, float right, float bottom)
	{
		const float values[] = {0, label, score, left, top, right, bottom};
		for (int i = 0; i < 7; i++) outputs.boxes.ptr<float>(0, 0, row)[i] = values[i];
	}

	std::vector<Detection> decode(cv::Size image = kNetwork) const
	{
		return decodeMaskRcnn(outputs, Letterbox(image, kNetwork), {});
	}

	MaskRcnnOutputs outputs;
};

TEST(MaskRcnnDecoder, RecognisesItsLayoutInEitherOrderOfOutputs)
{
	const FakeOutputs fake;
	const auto found = findMaskRcnnOutputs({fake.outputs.masks, fake.outputs.boxes});
	ASSERT_TRUE(found);
	EXPECT_EQ(found->labelCount(), kLabels);
	EXPECT_TRUE(findMaskRcnnOutputs({fake.outputs.boxes, fake.outputs.masks}));
	EXPECT_FALSE(findMaskRcnnOutputs({fake.outputs.masks, fake.outputs.masks}));
	EXPECT_FALSE(findMaskRcnnOutputs({fake.outputs.boxes}));
}

TEST(MaskRcnnDecoder, FindsNothingInTheRowOfZerosThatMeansNoDetection)
{
	EXPECT_TRUE(FakeOutputs().decode().empty());
}

TEST(MaskRcnnDecoder, ScalesTheBoxAndStretchesTheMaskOverIt)
{
	FakeOutputs fake;
	fake.set(1, 2, 0.7f, 0.1f, 0.25f, 0.5f, 0.75f);
	const auto detections = fake.decode();
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].box, cv::Rect(10, 20, 40, 40));
	EXPECT_EQ(detections[0].scores, LabelScores({{2, 0.7f}}));
	EXPECT_EQ(cv::countNonZero(detections[0].mask.rowRange(0, 20)), 20 * 40);
	EXPECT_EQ(cv::countNonZero(detections[0].mask.rowRange(20, 40)), 0);
}

TEST(MaskRcnnDecoder, TakesTheMaskOfTheBoxsOwnLabelAndRow)
{
	FakeOutputs fake;
	for (int y = 0; y < 4; y++)
		for (int x = 0; x < 4; x++) *fake.mask(1, 2, y, x) = x < 2 ? 0.8f : 0.2f;
	fake.set(1, 2, 0.7f, 0.1f, 0.25f, 0.5f, 0.75f);
	const auto mask = fake.decode().at(0).mask;
	EXPECT_EQ(cv::countNonZero(mask.colRange(0, 20)), 20 * 40);
	EXPECT_EQ(cv::countNonZero(mask.colRange(20, 40)), 0);
}

TEST(MaskRcnnDecoder, ABoxThatLeavesTheImageKeepsItsMaskInPlace)
{
	FakeOutputs fake;
	// Rows -40 to 40 of 80: the upper half of the mask ends at row 0.
	fake.set(0, 0, 0.7f, 0.1f, -0.5f, 0.5f, 0.5f);
	const auto detections = fake.decode();
	ASSERT_EQ(detections.size(), 1u);
	EXPECT_EQ(detections[0].box, cv::Rect(10, 0, 40, 40));
	EXPECT_EQ(cv::countNonZero(detections[0].mask), 0);
}

TEST(MaskRcnnDecoder, UndoesTheLetterbox)
{
	FakeOutputs fake;
	fake.set(0, 0, 0.7f, 0.0f, 0.1875f, 1.0f, 0.8125f);
	// 200 x 100 goes in at half size: 15 rows of grey above and below.
	EXPECT_EQ(fake.decode({200, 100}).at(0).box, cv::Rect(0, 0, 200, 100));
}

TEST(MaskRcnnDecoder, DropsRowsThatAreNotFiniteOrOfNoLabel)
{
	FakeOutputs fake;
	fake.set(0, 0, 0.7f, std::numeric_limits<float>::quiet_NaN(), 0, 1, 1);
	fake.set(1, kLabels, 0.7f, 0, 0, 1, 1);
	EXPECT_TRUE(fake.decode().empty());
	fake.set(1, -1, 0.7f, 0, 0, 1, 1);
	EXPECT_TRUE(fake.decode().empty());
}

TEST(MaskRcnnDecoder, MoreBoxesThanMasksAreNotRead)
{
	FakeOutputs fake;
	const int boxShape[] = {1, 1, 5, 7};
	fake.outputs.boxes = cv::Mat(4, boxShape, CV_32F, cv::Scalar(0));
	fake.set(4, 0, 0.7f, 0, 0, 1, 1);
	EXPECT_TRUE(fake.decode().empty());
}

TEST(MaskRcnnDecoder, TensorflowsNinetyLabelsMapToTheEightyOfCoco)
{
	const auto mapping = cocoLabelsOfTensorflow();
	const auto coco = LabelSet::coco();
	ASSERT_EQ(mapping.size(), 90u);
	// Ids of the COCO annotation files, counted from 1.
	const auto name = [&](std::size_t id) { return coco.name(mapping.at(id - 1).value()); };
	EXPECT_EQ(name(1), "person");
	EXPECT_EQ(name(13), "stop sign");
	EXPECT_EQ(name(62), "chair");
	EXPECT_EQ(name(72), "tv");
	EXPECT_EQ(name(73), "laptop");
	EXPECT_EQ(name(76), "keyboard");
	EXPECT_EQ(name(84), "book");
	EXPECT_EQ(name(90), "toothbrush");
	for (const std::size_t gap : {12, 26, 29, 30, 45, 66, 68, 69, 71, 83})
		EXPECT_FALSE(mapping.at(gap - 1)) << gap;
}

}  // namespace
