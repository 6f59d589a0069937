#include <gtest/gtest.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/ColorHistogramEmbedder.h>

#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

namespace
{
using namespace semloop;

const cv::Size kImage(40, 30);
const cv::Scalar kRed(30, 30, 200), kBlue(200, 30, 30);

Instance instanceIn(const cv::Rect& box, cv::Size image = kImage)
{
	Instance instance;
	cv::Mat mask = cv::Mat::zeros(image, CV_8UC1);
	mask(box).setTo(255);
	instance.mask = InstanceMask::encode(mask);
	instance.box = box;
	return instance;
}

double similarity(const std::vector<float>& a, const std::vector<float>& b)
{
	return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

TEST(ColorHistogramEmbedder, EmbeddingHasUnitLength)
{
	cv::Mat image(kImage, CV_8UC3);
	cv::theRNG().state = 3;
	cv::randu(image, 0, 256);
	const auto e = ColorHistogramEmbedder().embed(image, instanceIn({5, 5, 20, 20}));
	EXPECT_EQ(e.size(), 4u * 10u * 10u);
	EXPECT_NEAR(similarity(e, e), 1.0, 1e-5);
}

TEST(ColorHistogramEmbedder, OnlyPixelsOfTheMaskCount)
{
	cv::Mat image(kImage, CV_8UC3, kRed);
	cv::Mat other = image.clone();
	other.colRange(20, 40).setTo(kBlue);
	ColorHistogramEmbedder embedder;
	const auto instance = instanceIn({2, 2, 18, 20});
	EXPECT_EQ(embedder.embed(image, instance), embedder.embed(other, instance));
}

TEST(ColorHistogramEmbedder, SizeAndPlaceDoNotMatter)
{
	const cv::Mat image(kImage, CV_8UC3, kRed);
	ColorHistogramEmbedder embedder;
	EXPECT_NEAR(
		similarity(
			embedder.embed(image, instanceIn({0, 0, 4, 4})),
			embedder.embed(image, instanceIn({10, 5, 30, 20}))),
		1.0, 1e-5);
}

TEST(ColorHistogramEmbedder, DistantColoursShareNothing)
{
	const cv::Mat red(kImage, CV_8UC3, kRed), blue(kImage, CV_8UC3, kBlue);
	ColorHistogramEmbedder embedder;
	const auto instance = instanceIn({0, 0, 4, 4});
	EXPECT_NEAR(similarity(embedder.embed(red, instance), embedder.embed(blue, instance)), 0, 1e-6);
}

TEST(ColorHistogramEmbedder, HalfTheColourInCommonIsASimilarityOfSqrtHalf)
{
	cv::Mat red(kImage, CV_8UC3, kRed);
	cv::Mat both = red.clone();
	both.colRange(0, 20).setTo(kBlue);
	ColorHistogramEmbedder embedder;
	const auto whole = instanceIn({0, 0, 40, 30});
	EXPECT_NEAR(
		similarity(embedder.embed(red, whole), embedder.embed(both, whole)), std::sqrt(0.5), 1e-5);
}

TEST(ColorHistogramEmbedder, ALittleMoreLightChangesLittle)
{
	// Hard bins would jump from 1 to 0 somewhere on the way.
	ColorHistogramEmbedder embedder;
	const auto instance = instanceIn({0, 0, 4, 4});
	for (int grey = 20; grey < 230; grey++)
	{
		const cv::Mat darker(kImage, CV_8UC3, cv::Scalar::all(grey));
		const cv::Mat lighter(kImage, CV_8UC3, cv::Scalar::all(grey + 1));
		EXPECT_GT(
			similarity(embedder.embed(darker, instance), embedder.embed(lighter, instance)), 0.98)
			<< grey;
	}
}

TEST(ColorHistogramEmbedder, AnEmptyMaskHasNoEmbedding)
{
	Instance instance;
	instance.mask = InstanceMask(kImage);
	EXPECT_TRUE(ColorHistogramEmbedder().embed(cv::Mat(kImage, CV_8UC3), instance).empty());
}

TEST(ColorHistogramEmbedder, RefusesAnImageOfAnotherSizeOrKind)
{
	ColorHistogramEmbedder embedder;
	const auto instance = instanceIn({0, 0, 4, 4});
	EXPECT_THROW(embedder.embed(cv::Mat(31, 40, CV_8UC3), instance), InputError);
	EXPECT_THROW(embedder.embed(cv::Mat(30, 40, CV_8UC1), instance), InputError);
}

TEST(ColorHistogramEmbedder, AddEmbeddingsGivesEveryInstanceItsOwn)
{
	cv::Mat image(kImage, CV_8UC3, kRed);
	image.colRange(20, 40).setTo(kBlue);
	CObservationInstances observation;
	observation.instances = {instanceIn({0, 0, 10, 10}), instanceIn({25, 0, 10, 10})};
	ColorHistogramEmbedder embedder;
	addEmbeddings(embedder, image, observation);
	EXPECT_EQ(observation.instances[0].embedding, embedder.embed(image, observation.instances[0]));
	EXPECT_NE(observation.instances[0].embedding, observation.instances[1].embedding);
}

}  // namespace
