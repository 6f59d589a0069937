#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/UnixTime.h>

#include "CameraFixture.h"

namespace semloop::test
{
namespace
{
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Oni2Rawlog : public CameraFixture
{
protected:
	ShellResult convert(const std::string& arguments) const
	{
		return shell(
			"timeout 60 '" SEMLOOP_BINARY_DIR "/bin/oni2rawlog' " + arguments, folder_.path());
	}

	void expectFailure(const std::string& arguments, const std::string& saying, int code = 1) const
	{
		const auto result = convert(arguments);
		EXPECT_EQ(result.code, code) << result.err;
		EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
		EXPECT_THAT(result.err, HasSubstr(saying));
		EXPECT_FALSE(fs::exists(folder_.path() / "out.rawlog"));
	}

	/** Colour and depth of scans as programs read them: which frames they are. */
	static std::vector<int> framesRead(const std::vector<CObservation3DRangeScan::Ptr>& scans)
	{
		std::vector<int> frames;
		for (const auto& scan : scans)
		{
			const RgbdFrame frame = rgbdFrameFrom(*scan);
			cv::Mat millimetres;
			frame.depth.convertTo(millimetres, CV_16U, 1000);
			frames.push_back(frameOf(frame.color, millimetres));
		}
		return frames;
	}
};

TEST_F(Oni2Rawlog, WritesTheFramesOfTheRecording)
{
	record();
	const auto result = convert("--start-time 1305031453.25 recorded.oni out.rawlog");
	ASSERT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(result.err, "");
	EXPECT_EQ(
		result.out,
		"out.rawlog: 30 frames in 0.3 s from 1305031453.250000 on, 0 colour and 0 depth "
		"images without partner\n");
	const auto scans = scansIn(folder_.file("out.rawlog"));
	EXPECT_EQ(framesRead(scans), framesFromTo(0, kFrames - 1));
	ASSERT_EQ(scans.size(), std::size_t(kFrames));
	EXPECT_EQ(formatUnixTime(scans[0]->timestamp), "1305031453.250000");
	EXPECT_EQ(formatUnixTime(scans[29]->timestamp), "1305031453.540000");
	EXPECT_EQ(scans[0]->sensorLabel, "RGBD");
	EXPECT_TRUE(scans[0]->range_is_depth);
	EXPECT_FLOAT_EQ(scans[0]->rangeUnits, 1e-3f);
	EXPECT_NEAR(scans[0]->cameraParams.fx(), 52.5, 1e-4);
	EXPECT_NEAR(scans[0]->cameraParams.fy(), 53.5, 1e-4);
	EXPECT_TRUE(scans[0]->rangeImage_isExternallyStored());
	EXPECT_TRUE(fs::exists(folder_.path() / "out_Images/color_000029.png"));
	EXPECT_TRUE(fs::exists(folder_.path() / "out_Images/depth_000029.bin"));
}

TEST_F(Oni2Rawlog, EmbedsImages)
{
	record();
	ASSERT_EQ(convert("--embed recorded.oni out.rawlog").code, 0);
	EXPECT_FALSE(fs::exists(folder_.path() / "out_Images"));
	EXPECT_EQ(framesOf(scansIn(folder_.file("out.rawlog"))), framesFromTo(0, kFrames - 1));
}

TEST_F(Oni2Rawlog, CountsImagesWithoutPartner)
{
	record("record", {{"RATE", "100"}, {"DROP_COLOR", "5"}});
	EXPECT_THAT(
		convert("recorded.oni out.rawlog").out,
		AllOf(HasSubstr("24 frames"), HasSubstr("0 colour and 6 depth images without partner")));
}

TEST_F(Oni2Rawlog, TakesACameraFromAFile)
{
	record();
	folder_.write(
		"xtion.ini",
		"[CAMERA_PARAMS]\nresolution = [64 48]\nfx = 60\nfy = 61\ncx = 30\ncy = 20\ndist = [0 0 0 "
		"0 0]\n");
	ASSERT_EQ(convert("--camera xtion.ini recorded.oni out.rawlog").code, 0);
	EXPECT_EQ(scansIn(folder_.file("out.rawlog")).at(0)->cameraParams.fy(), 61);
}

TEST_F(Oni2Rawlog, LeavesTheFramesBeforeACutInThePartialFile)
{
	recordAndKill();
	expectFailure("--embed killed.oni out.rawlog", "the frames so far are in out.rawlog.partial");
	std::vector<CObservation3DRangeScan::Ptr> scans;
	EXPECT_EQ(
		messageOf<InputError>([&] { scans = scansIn(folder_.file("out.rawlog.partial")); }), "");
	ASSERT_GT(scans.size(), 1u);
	EXPECT_EQ(framesOf(scans), framesFromTo(0, int(scans.size()) - 1));
}

TEST_F(Oni2Rawlog, SaysWhatIsWrong)
{
	expectFailure("none.oni out.rawlog", "none.oni: no such file");
	folder_.write("text.oni", "Dear diary\n");
	expectFailure("text.oni out.rawlog", "text.oni: no recording of OpenNI2");
	expectFailure("--start-time noon text.oni out.rawlog", "--start-time noon: must be", 2);
	record("record-color");
	expectFailure("recorded.oni out.rawlog", "recorded.oni: has no depth images");
	const std::string bytes = readBytes(record());
	folder_.write("cut.oni", bytes.substr(0, bytes.size() / 4));
	expectFailure("cut.oni out.rawlog", "cut.oni: OpenNI2 cannot open it: the file was cut");
	expectFailure("--camera none.ini recorded.oni out.rawlog", "none.ini: no such file", 2);
	folder_.write(
		"vga.ini",
		"[CAMERA_PARAMS]\nresolution = [640 480]\nfx = 600\nfy = 600\ncx = 300\ncy = 200\ndist = "
		"[0 0 0 0 0]\n");
	expectFailure("--camera vga.ini recorded.oni out.rawlog", "of 64x48 pixels where the camera");
	expectFailure("recorded.oni no/folder/out.rawlog", "no/folder/out.rawlog");
}

}  // namespace
}  // namespace semloop::test
