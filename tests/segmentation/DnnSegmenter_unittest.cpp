#include "TinyOnnx.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/segmentation/DnnSegmenter.h>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>

namespace
{
using namespace semloop;
using testing::HasSubstr;

/** A folder with networks, gone after the test. */
class DnnSegmenterTest : public testing::Test
{
protected:
	DnnSegmenterTest()
	{
		const auto* info = testing::UnitTest::GetInstance()->current_test_info();
		folder_ = std::filesystem::temp_directory_path() /
				  (std::string("semloop-") + info->name() + std::to_string(getpid()));
		std::filesystem::create_directories(folder_);
	}
	~DnnSegmenterTest() override { std::filesystem::remove_all(folder_); }

	std::string write(const std::string& name, const std::string& bytes)
	{
		const auto path = (folder_ / name).string();
		test::writeFile(path, bytes);
		return path;
	}

	/** Options of the tiny YOLO-seg network, for its two labels. */
	DnnSegmenterOptions tinyOptions()
	{
		DnnSegmenterOptions options;
		options.model = write("tiny.onnx", test::tinyYoloSeg());
		options.labels = write("labels.txt", "lamp\nvase\n");
		options.minArea = 1;
		return options;
	}

	/** The message that configuring fails with. */
	static std::string errorOf(const DnnSegmenterOptions& options)
	{
		try
		{
			DnnSegmenter().configure(options);
		}
		catch (const InputError& e)
		{
			return e.what();
		}
		return "no error";
	}

	std::filesystem::path folder_;
};

RgbdFrame frameOf(cv::Size size)
{
	RgbdFrame frame;
	frame.time = mrpt::Clock::fromDouble(12.5);
	frame.color = cv::Mat(size, CV_8UC3, cv::Scalar(90, 90, 90));
	frame.camera.ncols = uint32_t(size.width);
	frame.camera.nrows = uint32_t(size.height);
	frame.T_robot_camera = robotFromCamera(mrpt::poses::CPose3D(1, 2, 3, 0.1, 0.2, 0.3));
	return frame;
}

TEST_F(DnnSegmenterTest, FindsWhatTheNetworkSees)
{
	DnnSegmenter segmenter;
	segmenter.configure(tinyOptions());
	const auto found = segmenter.segment(frameOf({64, 32}));
	ASSERT_EQ(found->instances.size(), 2u);

	const auto& lamp = found->instances[0];
	EXPECT_EQ(found->labels.name(lamp.label()), "lamp");
	EXPECT_EQ(lamp.box, cv::Rect(8, 8, 16, 16));
	EXPECT_EQ(lamp.mask.area(), 256u);
	EXPECT_FLOAT_EQ(lamp.confidence, 0.9f);
	EXPECT_FLOAT_EQ(lamp.labelScores[0].score, 0.75f);
	EXPECT_FLOAT_EQ(lamp.labelScores[1].score, 0.25f);

	const auto& vase = found->instances[1];
	EXPECT_EQ(found->labels.name(vase.label()), "vase");
	EXPECT_EQ(vase.box, cv::Rect(40, 4, 8, 24)) << "the prototype is negative from column 48 on";
	EXPECT_EQ(vase.labelScores.size(), 1u);
	EXPECT_NO_THROW(found->validate());
}

TEST_F(DnnSegmenterTest, TheObservationIsOfTheFramesTimeCameraAndPose)
{
	DnnSegmenter segmenter;
	segmenter.configure(tinyOptions());
	const auto found = segmenter.segment(frameOf({64, 32}));
	EXPECT_EQ(found->timestamp, mrpt::Clock::fromDouble(12.5));
	EXPECT_EQ(found->imageSize(), cv::Size(64, 32));
	const mrpt::poses::CPose3D expected(1, 2, 3, 0.1, 0.2, 0.3);
	EXPECT_NEAR((found->sensorPose.asVectorVal() - expected.asVectorVal()).norm(), 0, 1e-9);
}

TEST_F(DnnSegmenterTest, AnImageOfAnotherSizeIsFittedIn)
{
	DnnSegmenter segmenter;
	segmenter.configure(tinyOptions());
	const auto found = segmenter.segment(frameOf({128, 128}));
	// Scaled by 1/4, with 16 columns of grey on both sides: the vase lies at columns 24 to 32 of 32.
	ASSERT_EQ(found->instances.size(), 2u);
	EXPECT_EQ(found->instances[0].box, cv::Rect(0, 32, 32, 64));
	EXPECT_EQ(found->instances[1].box, cv::Rect(96, 16, 32, 96));
}

TEST_F(DnnSegmenterTest, TakesItsOptionsFromTheSection)
{
	const auto options = tinyOptions();
	mrpt::config::CConfigFileMemory config;
	config.write("segmentation", "model", options.model);
	config.write("segmentation", "labels", options.labels);
	config.write("segmentation", "min_area", 200);
	config.write("segmentation", "min_label_score", 0.5);
	DnnSegmenter segmenter;
	segmenter.configure(config, "segmentation");
	const auto found = segmenter.segment(frameOf({64, 32}));
	ASSERT_EQ(found->instances.size(), 1u) << "the vase has 192 pixels";
	EXPECT_EQ(found->instances[0].labelScores.size(), 1u);

	config.write("segmentation", "min_are", 200);
	EXPECT_THROW(segmenter.configure(config, "segmentation"), UsageError);
}

TEST_F(DnnSegmenterTest, RecognisesAMaskRcnnByItsOutputs)
{
	std::vector<float> masks(90 * 4, -1.0f);
	for (int i = 0; i < 4; i++) masks[71 * 4 + i] = 1.0f;
	DnnSegmenterOptions options;
	options.model = write(
		"rcnn.onnx",
		test::tinyOnnx(
			{1, 3, -1, -1}, {{"boxes", {1, 1, 1, 7}, {0, 71, 0.9f, 0.25f, 0.25f, 0.75f, 0.75f}},
							 {"masks", {1, 90, 2, 2}, masks}}));
	EXPECT_THAT(errorOf(options), HasSubstr("set input_width and input_height"));
	options.inputWidth = options.inputHeight = 80;
	DnnSegmenter segmenter;
	segmenter.configure(options);
	const auto found = segmenter.segment(frameOf({80, 80}));
	ASSERT_EQ(found->instances.size(), 1u);
	EXPECT_EQ(found->instances[0].box, cv::Rect(20, 20, 40, 40));
	EXPECT_EQ(found->labels.name(found->instances[0].label()), "tv");
}

/** A frozen TensorFlow graph that reshapes an image of 7 x 4 to rows of 7 as "detection_out_final" and
 *  goes on from there to "detection_masks", as Mask R-CNN does. */
std::string tinyTensorflowGraph()
{
	using test::ProtoWriter;
	const auto attribute = [](const std::string& key, const ProtoWriter& value)
	{ return ProtoWriter().bytes(1, key).message(2, value); };
	const auto node = [](const std::string& name, const std::string& op)
	{ return ProtoWriter().bytes(1, name).bytes(2, op); };
	constexpr int kFloat = 1, kInt32 = 3;

	ProtoWriter shape;
	shape.number(1, kInt32).message(2, ProtoWriter().message(2, ProtoWriter().number(1, 4)));
	for (const uint64_t size : {1, 1, 12, 7}) shape.number(7, size);
	ProtoWriter graph;
	graph.message(
		1, node("image_tensor", "Placeholder")
			   .message(5, attribute("dtype", ProtoWriter().number(6, kFloat))));
	graph.message(
		1, node("shape", "Const")
			   .message(5, attribute("dtype", ProtoWriter().number(6, kInt32)))
			   .message(5, attribute("value", ProtoWriter().message(8, shape))));
	graph.message(
		1, node("detection_out_final", "Reshape").bytes(3, "image_tensor").bytes(3, "shape"));
	graph.message(1, node("detection_masks", "Sigmoid").bytes(3, "detection_out_final"));
	return graph.str();
}

TEST_F(DnnSegmenterTest, TakesTheBoxesOutOfTheMiddleOfATensorflowGraph)
{
	DnnSegmenterOptions options;
	options.model = write("frozen.pb", tinyTensorflowGraph());
	options.inputWidth = 7;
	options.inputHeight = 4;
	// The axes are in OpenCV's order, so this is no Mask R-CNN; but both outputs were there to look at.
	EXPECT_THAT(
		errorOf(options), HasSubstr("detection_out_final 1x7x1x12, detection_masks 1x7x1x12"));
}

TEST_F(DnnSegmenterTest, ErrorsNameTheFileWhatWasFoundAndARemedy)
{
	auto options = tinyOptions();
	options.labels.clear();
	EXPECT_THAT(errorOf(options), testing::AllOf(HasSubstr("2 labels"), HasSubstr("has 80")));
	options.labels = write("three.txt", "a\nb\nc\n");
	EXPECT_THAT(errorOf(options), testing::AllOf(HasSubstr("2 labels"), HasSubstr("has 3")));

	options = tinyOptions();
	options.inputWidth = options.inputHeight = 320;
	EXPECT_THAT(
		errorOf(options),
		testing::AllOf(HasSubstr("tiny.onnx"), HasSubstr("64x32"), HasSubstr("320x320")));

	options.model = "/no/such/network.onnx";
	EXPECT_THAT(errorOf(options), HasSubstr("/no/such/network.onnx: no such network file"));
	options.model.clear();
	EXPECT_THAT(errorOf(options), HasSubstr("set model"));
	options = tinyOptions();
	options.modelConfig = "/no/such/graph.pbtxt";
	EXPECT_THAT(errorOf(options), HasSubstr("/no/such/graph.pbtxt"));
}

TEST_F(DnnSegmenterTest, RefusesANetworkOfAnotherLayout)
{
	DnnSegmenterOptions options;
	options.model = write("embedding.onnx", test::tinyEmbedding());
	const auto error = errorOf(options);
	EXPECT_THAT(error, HasSubstr("feature 1x3"));
	EXPECT_THAT(error, HasSubstr("doc/segmentation-networks.md"));

	options.model = write("grey.onnx", test::tinyOnnx({1, 1, 8, 8}, {{"out", {1, 3}, {0, 0, 0}}}));
	EXPECT_THAT(errorOf(options), HasSubstr("not one colour image"));
}

TEST_F(DnnSegmenterTest, RefusesFilesThatAreDamagedOrOfAnotherKind)
{
	DnnSegmenterOptions options;
	options.model = write("text.onnx", "no network");
	EXPECT_THAT(errorOf(options), HasSubstr("not an ONNX network"));
	const auto whole = test::tinyYoloSeg();
	options.model = write("cut.onnx", whole.substr(0, whole.size() / 2));
	EXPECT_THAT(errorOf(options), HasSubstr("cut.onnx: not an ONNX network, or damaged"));
	options.model = write("network.pb", "no network");
	options.inputWidth = options.inputHeight = 320;
	EXPECT_THAT(errorOf(options), HasSubstr("network.pb: OpenCV cannot load it"));
	options.model = write("network.txt", "no network");
	EXPECT_THAT(errorOf(options), HasSubstr("network.txt: OpenCV cannot load it"));
}

TEST_F(DnnSegmenterTest, ANetworkThatDoesNotLoadHintsAtItsOpset)
{
	using test::ProtoWriter;
	namespace onnx = test::onnx;
	ProtoWriter graph;
	graph.message(1, onnx::node("OperatorOfTomorrow", {"image"}, "out"));
	graph.message(11, onnx::value("image", {1, 3, 8, 8}));
	graph.message(12, onnx::value("out", {1, 3, 8, 8}));
	DnnSegmenterOptions options;
	options.model = write(
		"new.onnx",
		ProtoWriter().number(1, 5).message(8, ProtoWriter().number(2, 17)).message(7, graph).str());
	EXPECT_THAT(errorOf(options), testing::AllOf(HasSubstr("cannot load"), HasSubstr("opset 17")));
}

TEST_F(DnnSegmenterTest, RefusesAFrameWithoutColour)
{
	DnnSegmenter segmenter;
	segmenter.configure(tinyOptions());
	EXPECT_THROW(segmenter.segment(RgbdFrame()), InputError);
	EXPECT_THROW(DnnSegmenter().segment(frameOf({64, 32})), UsageError);
}

TEST(DnnSegmenter, IsMadeByItsName)
{
	const auto made = mrpt::rtti::classFactory("semloop::DnnSegmenter");
	EXPECT_TRUE(std::dynamic_pointer_cast<Segmenter>(made));
}

/** With the network and a picture from $SEMLOOP_DATA. */
TEST(DnnSegmenter, SeesTheScreensAndTheKeyboardOnARealDeskAndAlwaysTheSame)
{
	const char* data = std::getenv("SEMLOOP_DATA");
	if (!data) GTEST_SKIP() << "SEMLOOP_DATA is not set";
	const auto root = std::filesystem::path(data);
	DnnSegmenterOptions options;
	options.model = (root / "models/yolo11n-seg-480x640.onnx").string();
	RgbdFrame frame = frameOf({640, 480});
	frame.color = cv::imread((root / "data/tum_fr1_desk/rgb/1305031468.095867.jpg").string());
	ASSERT_FALSE(frame.color.empty());

	DnnSegmenter segmenter;
	segmenter.configure(options);
	const auto first = segmenter.segment(frame);
	std::map<std::string, int> count;
	for (const auto& instance : first->instances) count[first->labels.name(instance.label())]++;
	EXPECT_EQ(count["tv"], 2);
	EXPECT_EQ(count["keyboard"], 1);
	EXPECT_EQ(count["chair"], 1);

	const auto second = segmenter.segment(frame);
	ASSERT_EQ(first->instances.size(), second->instances.size());
	for (std::size_t i = 0; i < first->instances.size(); i++)
	{
		EXPECT_EQ(first->instances[i].mask, second->instances[i].mask);
		EXPECT_EQ(first->instances[i].labelScores, second->instances[i].labelScores);
		EXPECT_EQ(first->instances[i].confidence, second->instances[i].confidence);
	}
}

}  // namespace
