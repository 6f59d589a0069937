#include "TinyOnnx.h"

#include <gtest/gtest.h>
#include <semloop/segmentation/OnnxInfo.h>

namespace
{
using namespace semloop;

TEST(OnnxInfo, ReadsShapeOfTheInputAndOpset)
{
	const auto info = parseOnnxInfo(test::tinyOnnx({1, 3, 32, 64}, {{"out", {1, 2}, {0, 0}}}, 12));
	ASSERT_TRUE(info);
	EXPECT_EQ(info->inputShape, std::vector<int64_t>({1, 3, 32, 64}));
	EXPECT_EQ(info->opset, 12);
}

TEST(OnnxInfo, ASizeLeftOpenIsMinusOne)
{
	const auto info = parseOnnxInfo(test::tinyOnnx({1, 3, -1, 64}, {{"out", {1, 2}, {0, 0}}}));
	ASSERT_TRUE(info);
	EXPECT_EQ(info->inputShape, std::vector<int64_t>({1, 3, -1, 64}));
}

TEST(OnnxInfo, PassesOverWeightsThatAreListedAsInputs)
{
	using test::ProtoWriter;
	ProtoWriter graph;
	graph.message(11, test::onnx::value("weights", {7, 7}));
	graph.message(11, test::onnx::value("image", {1, 3, 8, 8}));
	graph.message(5, test::onnx::tensor<float>("weights", 1, {1}, {0}));
	const auto info = parseOnnxInfo(ProtoWriter().message(7, graph).str());
	ASSERT_TRUE(info);
	EXPECT_EQ(info->inputShape, std::vector<int64_t>({1, 3, 8, 8}));
}

TEST(OnnxInfo, EveryTruncationIsRefusedOrReadWithoutHarm)
{
	const auto bytes = test::tinyOnnx({1, 3, 32, 64}, {{"out", {1, 2}, {0, 0}}});
	for (std::size_t size = 0; size < bytes.size(); size++)
		EXPECT_FALSE(parseOnnxInfo(bytes.substr(0, size))) << size;
}

TEST(OnnxInfo, RefusesWhatIsNoNetwork)
{
	EXPECT_FALSE(parseOnnxInfo(""));
	EXPECT_FALSE(parseOnnxInfo("this is a text and not a network"));
	EXPECT_FALSE(parseOnnxInfo(std::string(100, '\xff')));
	EXPECT_FALSE(readOnnxInfo("/no/such/file.onnx"));
}

}  // namespace
