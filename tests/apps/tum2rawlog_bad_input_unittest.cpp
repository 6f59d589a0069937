#include "Tum2RawlogFixture.h"

namespace semloop::test
{
namespace
{
using ::testing::HasSubstr;

class Tum2RawlogBadInput : public Tum2Rawlog
{
};

TEST_F(Tum2RawlogBadInput, WrongUsageExitsWith2)
{
	for (const std::string options :
		 {"--camera fr9", "--max-time-difference -1", "--max-time-difference x", "--no-such-option",
		  "--max-time-difference nan"})
	{
		EXPECT_EQ(run(options), 2) << options;
		EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
	}
	EXPECT_EQ(runWith("'" + sequence_.string() + "'"), 2);
	const auto noCamera = folder_.write("bad.ini", "[A]\nfx = 3\n");
	EXPECT_EQ(run("--camera '" + noCamera + "'"), 2);
	EXPECT_THAT(err_, HasSubstr(noCamera));
	EXPECT_EQ(runWith("--help"), 0);
	EXPECT_THAT(out_, HasSubstr("--embed"));
}

TEST_F(Tum2RawlogBadInput, AMissingFolderOrListIsNamed)
{
	fs::remove(sequence_ / "depth.txt");
	expectFailure({"depth.txt", "not there", "TUM RGB-D"});
	fs::remove(sequence_ / "rgb.txt");
	expectFailure({"rgb.txt"});
	EXPECT_EQ(runWith("/nonexistent '" + rawlog_ + "'"), 1);
	EXPECT_THAT(err_, HasSubstr("/nonexistent: no such folder"));
	EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
}

TEST_F(Tum2RawlogBadInput, ADepthImageOf8BitsIsNamed)
{
	cv::imwrite((sequence_ / "depth/b.png").string(), cv::Mat(kSize, CV_8UC1, cv::Scalar(9)));
	expectFailure({"depth/b.png", "8 bits"});
}

TEST_F(Tum2RawlogBadInput, AnImageOfAnotherSizeIsNamed)
{
	cv::imwrite((sequence_ / "rgb/b.png").string(), cv::Mat(240, 320, CV_8UC3, cv::Scalar(9)));
	expectFailure({"rgb/b.png", "320x240", "640x480"});
}

TEST_F(Tum2RawlogBadInput, AWrongFirstImageDoesNotCostAnEarlierRawlog)
{
	ASSERT_EQ(run(), 0) << err_;
	const auto earlier = readBytes(rawlog_);
	cv::imwrite((sequence_ / "rgb/a.jpg").string(), cv::Mat(240, 320, CV_8UC3, cv::Scalar(9)));
	EXPECT_EQ(run(), 1);
	EXPECT_EQ(readBytes(rawlog_), earlier);
	EXPECT_EQ(readScans().size(), 2u);
	EXPECT_TRUE(fs::exists(folder_.path() / "x_Images/depth_000001.bin"));
}

TEST_F(Tum2RawlogBadInput, AMissingOrDamagedImageIsNamed)
{
	const auto path = (sequence_ / "rgb/a.jpg").string();
	const auto bytes = readBytes(path);
	write("rgb/a.jpg", bytes.substr(0, bytes.size() / 2));
	expectFailure({path, "cut"});
	fs::remove(path);
	expectFailure({path, "missing"});
}

TEST_F(Tum2RawlogBadInput, ABadLineIsNamedWithItsNumber)
{
	write("depth.txt", "# depth\n10.005 depth/a.png\n10.01\n");
	expectFailure({"depth.txt:3: 1 columns"});
	write("depth.txt", "yesterday depth/a.png\n");
	expectFailure({"depth.txt:1: 'yesterday'"});
	write("depth.txt", "10.005 depth/a.png\n10.032 depth/b.png\n");
	write("accelerometer.txt", "9.5 0.1 9.7 -0.5\n\n9.6 0.1 nan -0.5\n");
	expectFailure({"accelerometer.txt:3: 'nan'"});
	write("accelerometer.txt", "");
	write("groundtruth.txt", "1 2 3\n");
	expectFailure({"groundtruth.txt:1: 3 columns"});
}

TEST_F(Tum2RawlogBadInput, NoPairWithinTheTimeDifferenceIsTold)
{
	expectFailure({"--max-time-difference"}, "--max-time-difference 0.0001");
	write("rgb.txt", "# nothing\n");
	expectFailure({"rgb.txt", "no image"});
}

TEST_F(Tum2RawlogBadInput, AnUnwritablePlaceIsTold)
{
	EXPECT_EQ(runWith("'" + sequence_.string() + "' /nonexistent/x.rawlog"), 1);
	EXPECT_THAT(err_, AllOf(HasSubstr("/nonexistent/x"), HasSubstr("cannot be written")));
}
}  // namespace
}  // namespace semloop::test
