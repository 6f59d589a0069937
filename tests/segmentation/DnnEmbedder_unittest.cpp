#include "TinyOnnx.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/config/Error.h>
#include <semloop/segmentation/DnnEmbedder.h>

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <opencv2/imgcodecs.hpp>

namespace
{
using namespace semloop;
using testing::HasSubstr;

const cv::Size kImage(40, 30);

class DnnEmbedderTest : public testing::Test
{
protected:
	~DnnEmbedderTest() override { std::filesystem::remove(path_); }

	/** Options of a network of these bytes. */
	DnnEmbedderOptions network(const std::string& bytes)
	{
		test::writeFile(path_, bytes);
		DnnEmbedderOptions options;
		options.model = path_;
		return options;
	}

	static std::string errorOf(const DnnEmbedderOptions& options)
	{
		try
		{
			DnnEmbedder().configure(options);
		}
		catch (const InputError& e)
		{
			return e.what();
		}
		return "no error";
	}

	std::string path_ = (std::filesystem::temp_directory_path() /
						 ("semloop-embedder" + std::to_string(getpid()) + ".onnx"))
							.string();
};

Instance instanceOf(const cv::Mat& mask)
{
	Instance instance;
	instance.mask = InstanceMask::encode(mask);
	instance.box = instance.mask.boundingBox();
	return instance;
}

Instance instanceIn(const cv::Rect& box)
{
	cv::Mat mask = cv::Mat::zeros(kImage, CV_8UC1);
	mask(box).setTo(255);
	return instanceOf(mask);
}

TEST_F(DnnEmbedderTest, TheNetworkGetsNormalisedRgbAndTheResultHasUnitLength)
{
	DnnEmbedder embedder;
	embedder.configure(network(test::tinyEmbedding()));
	const cv::Mat red(kImage, CV_8UC3, cv::Scalar(0, 0, 255));
	const auto e = embedder.embed(red, instanceIn({4, 4, 20, 10}));
	// Mean colours (1, -1, -1) in R, G, B.
	ASSERT_EQ(e.size(), 3u);
	EXPECT_NEAR(e[0], std::sqrt(1.0 / 3), 1e-6);
	EXPECT_NEAR(e[1], -std::sqrt(1.0 / 3), 1e-6);
	EXPECT_NEAR(e[2], -std::sqrt(1.0 / 3), 1e-6);
}

TEST_F(DnnEmbedderTest, TheBackgroundInTheBoxDoesNotCount)
{
	DnnEmbedder embedder;
	embedder.configure(network(test::tinyEmbedding()));
	cv::Mat mask = cv::Mat::zeros(kImage, CV_8UC1);
	mask(cv::Rect(0, 0, 16, 8)).setTo(255);
	mask(cv::Rect(0, 8, 8, 8)).setTo(255);
	cv::Mat image(kImage, CV_8UC3, cv::Scalar(0, 0, 255));
	const auto plain = embedder.embed(image, instanceOf(mask));
	image.setTo(cv::Scalar(255, 0, 0), mask == 0);
	EXPECT_EQ(embedder.embed(image, instanceOf(mask)), plain);
	EXPECT_NEAR(plain[0], std::sqrt(1.0 / 3), 1e-6) << "grey is zero and changes no direction";
}

TEST_F(DnnEmbedderTest, TheWholeBoxIsSeenWhateverItsProportions)
{
	DnnEmbedder embedder;
	embedder.configure(network(test::tinyEmbedding()));
	// Left quarter red, the rest black: means (-1/2, -1, -1).
	cv::Mat image(kImage, CV_8UC3, cv::Scalar(0, 0, 0));
	image.colRange(0, 10).setTo(cv::Scalar(0, 0, 255));
	const auto e = embedder.embed(image, instanceIn({0, 10, 40, 8}));
	EXPECT_NEAR(e[0], -0.5 / 1.5, 1e-5);
	EXPECT_NEAR(e[1], -1.0 / 1.5, 1e-5);
}

TEST_F(DnnEmbedderTest, MeanAndScaleAreOptions)
{
	auto options =
		network(test::tinyOnnx({1, 3, 8, 8}, {{"feature", {1, 2}, {0, 1}, {1, 0, 0, 0, 0, 0}}}));
	options.mean = 0;
	options.scale = 1.0 / 255;
	DnnEmbedder embedder;
	embedder.configure(options);
	// (200 / 255, 1)
	const cv::Mat image(kImage, CV_8UC3, cv::Scalar(0, 0, 200));
	const auto e = embedder.embed(image, instanceIn({4, 4, 20, 10}));
	EXPECT_NEAR(e[0] / e[1], 200.0 / 255, 1e-6);
}

TEST_F(DnnEmbedderTest, AnEmptyMaskHasNoEmbedding)
{
	DnnEmbedder embedder;
	embedder.configure(network(test::tinyEmbedding()));
	Instance instance;
	instance.mask = InstanceMask(kImage);
	EXPECT_TRUE(embedder.embed(cv::Mat(kImage, CV_8UC3), instance).empty());
}

TEST_F(DnnEmbedderTest, RefusesNetworksThatDoNotGiveOneVector)
{
	EXPECT_THAT(errorOf(network(test::tinyYoloSeg())), HasSubstr("output0 1x7x42"));
	EXPECT_THAT(
		errorOf(network(test::tinyOnnx({1, 3, 8, 8}, {{"map", {1, 2, 2}, {0, 0, 0, 0}}}))),
		HasSubstr("map 1x2x2"));
	EXPECT_THAT(errorOf(DnnEmbedderOptions()), HasSubstr("set model"));
	DnnEmbedderOptions missing;
	missing.model = "/no/such/network.onnx";
	EXPECT_THAT(errorOf(missing), HasSubstr("no such network file"));
}

TEST_F(DnnEmbedderTest, AnOutputOfZerosOrAnImageOfAnotherSizeIsAnError)
{
	DnnEmbedder embedder;
	EXPECT_THROW(embedder.embed(cv::Mat(kImage, CV_8UC3), instanceIn({0, 0, 9, 9})), UsageError);
	embedder.configure(network(test::tinyOnnx({1, 3, 8, 8}, {{"feature", {1, 2}, {0, 0}}})));
	const cv::Mat image(kImage, CV_8UC3, cv::Scalar(0, 0, 200));
	EXPECT_THROW(embedder.embed(image, instanceIn({0, 0, 9, 9})), InputError);
	EXPECT_THROW(embedder.embed(image.rowRange(0, 20), instanceIn({0, 0, 9, 9})), InputError);
}

TEST(DnnEmbedder, IsMadeByItsName)
{
	const auto made = mrpt::rtti::classFactory("semloop::DnnEmbedder");
	EXPECT_TRUE(std::dynamic_pointer_cast<Embedder>(made));
	EXPECT_TRUE(std::dynamic_pointer_cast<Embedder>(
		mrpt::rtti::classFactory("semloop::ColorHistogramEmbedder")));
}

/** With the network and a picture from $SEMLOOP_DATA. */
TEST(DnnEmbedder, ABookResemblesItselfMoreThanAnotherOneAndAlwaysTheSame)
{
	const char* data = std::getenv("SEMLOOP_DATA");
	if (!data) GTEST_SKIP() << "SEMLOOP_DATA is not set";
	const auto root = std::filesystem::path(data);
	DnnEmbedderOptions options;
	options.model = (root / "models/mobilenetv1_imagenet_feat1024.onnx").string();
	DnnEmbedder embedder;
	embedder.configure(options);

	const cv::Mat image =
		cv::imread((root / "data/tum_fr1_desk/rgb/1305031465.595599.jpg").string());
	ASSERT_FALSE(image.empty());
	const auto embed = [&](const cv::Rect& box)
	{
		cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
		mask(box).setTo(255);
		return embedder.embed(image, instanceOf(mask));
	};
	const auto similarity = [](const std::vector<float>& a, const std::vector<float>& b)
	{ return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); };

	const auto book = embed({94, 323, 114, 123}), chair = embed({56, 119, 130, 141});
	EXPECT_EQ(book.size(), 1024u);
	EXPECT_NEAR(similarity(book, book), 1, 1e-5);
	EXPECT_GT(similarity(book, embed({98, 330, 108, 112})), similarity(book, chair) + 0.1);
	EXPECT_EQ(embed({94, 323, 114, 123}), book);
}

}  // namespace
