#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/RgbdFrame.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "Shell.h"
#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using testing::HasSubstr;

/** Random squares; every seed another picture. */
mrpt::obs::CObservation3DRangeScan::Ptr pictureAt(double seconds, int seed)
{
	cv::RNG random(std::uint64_t(seed + 1));
	cv::Mat color(120, 160, CV_8UC3, cv::Scalar(100, 100, 100));
	for (int i = 0; i < 60; ++i)
	{
		const cv::Rect square(random.uniform(0, 150), random.uniform(0, 110), 9, 9);
		color(square).setTo(cv::Scalar::all(random.uniform(0, 255)));
	}
	const cv::Mat depth(color.size(), CV_16UC1, cv::Scalar(1000));
	mrpt::img::TCamera camera;
	camera.ncols = 160;
	camera.nrows = 120;
	camera.setIntrinsicParamsFromValues(130, 130, 80, 60);
	auto scan = rangeScanFrom(color, depth, 0.001f, camera);
	scan->timestamp = mrpt::Clock::fromDouble(seconds);
	return scan;
}

class RawlogTrainVocabulary : public testing::Test
{
protected:
	RawlogTrainVocabulary()
	{
		RawlogWriter writer(folder.file("in.rawlog"));
		for (int i = 0; i < 12; ++i) writer.write(*pictureAt(i, i));
		writer.close();
	}
	ShellResult run(const std::string& arguments) const
	{
		return shell(
			std::string(SEMLOOP_BINARY_DIR) + "/bin/rawlog-train-vocabulary " + arguments,
			folder.path());
	}
	const TemporaryFolder folder;
};

TEST_F(RawlogTrainVocabulary, WritesTheSameFileForTheSameImages)
{
	const auto first = run("--every 2 --branching 4 --levels 2 -o a.vocabulary in.rawlog");
	ASSERT_EQ(first.code, 0) << first.err;
	EXPECT_THAT(first.out, HasSubstr("a.vocabulary: 16 words of"));
	EXPECT_THAT(first.out, HasSubstr("in 6 images"));
	ASSERT_EQ(run("--every 2 --branching 4 --levels 2 -o b.vocabulary in.rawlog").code, 0);
	EXPECT_EQ(readBytes(folder.file("a.vocabulary")), readBytes(folder.file("b.vocabulary")));
	ASSERT_EQ(run("--every 2 --branching 4 --levels 2 --seed 2 -o c in.rawlog in.rawlog").code, 0);
	EXPECT_NE(readBytes(folder.file("a.vocabulary")), readBytes(folder.file("c")));
}

TEST_F(RawlogTrainVocabulary, WhatIsWrongIsSaidInALineAndNothingIsWritten)
{
	const auto expect = [&](const std::string& arguments, int status, const std::string& text)
	{
		const auto result = run(arguments);
		EXPECT_EQ(result.code, status) << result.err;
		EXPECT_THAT(result.err, HasSubstr(text));
		EXPECT_FALSE(std::filesystem::exists(folder.file("out")));
	};
	expect("-o out none.rawlog", 1, "none.rawlog");
	expect("-o out --levels 9 in.rawlog", 2, "--levels must lie in [1, 8]");
	expect("-o out --every 12 in.rawlog", 1, "in 1 images are too few");
	expect("-o out --every 1 --max-images 5 in.rawlog", 1, "more than 5 images");
	const auto bytes = readBytes(folder.file("in.rawlog"));
	std::ofstream(folder.file("cut.rawlog"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
	expect("-o out --every 1 cut.rawlog", 1, "cut.rawlog");
	std::ofstream(folder.file("there")) << "mine";
	EXPECT_EQ(run("-o there in.rawlog").code, 2);
	EXPECT_EQ(readBytes(folder.file("there")), "mine");
}
}  // namespace
