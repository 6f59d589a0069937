#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "../observations/TestScan.h"
#include "Shell.h"
#include "TwoInstances.h"

namespace
{
using namespace semloop;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/** semloop-rawlog-info, the program, in a folder of its own. */
class SemloopRawlogInfo : public testing::Test
{
protected:
	ShellResult run(const std::string& arguments) const
	{
		return shell(
			"'" SEMLOOP_BINARY_DIR "/bin/semloop-rawlog-info' " + arguments, folder_.path());
	}

	TemporaryFolder folder_;
};

TEST_F(SemloopRawlogInfo, TellsStreamsRatesGapsImagesAndInstances)
{
	RawlogWriter writer(folder_.file("a.rawlog"));
	for (const double time : {100.0, 100.1, 100.2, 101.0, 101.1})
	{
		const auto scan = makeScan();
		scan->timestamp = mrpt::Clock::fromDouble(time);
		writer.write(*scan);
		writer.write(twoInstances(time));
	}
	writer.close();
	const auto result = run("a.rawlog");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(
		result.out,
		"a.rawlog: 10 observations in 1.100 s from 1970/01/01,00:01:40.000000 UTC\n"
		"  RGBD: 5 mrpt::obs::CObservation3DRangeScan\n"
		"    0.000 s to 1.100 s, 3.64 a second\n"
		"    1 gap: 0.800 s at 0.200 s\n"
		"    camera 64x48, f 52, colour 64x48, depth 64x48 in steps of 0.2 mm\n"
		"  instances: 5 semloop::CObservationInstances\n"
		"    0.000 s to 1.100 s, 3.64 a second\n"
		"    1 gap: 0.800 s at 0.200 s\n"
		"    masks 64x48, with depth\n"
		"           5 mug\n"
		"           5 potted plant\n"
		"  From observation 1 on MRPT's own programs need libsemloop-observations.so (rawlog-edit "
		"-p, "
		"RawLogViewer -l, else LD_PRELOAD): without it they stop there and say so on stderr "
		"only.\n");
}

TEST_F(SemloopRawlogInfo, NeedsNoPlugInWhereThereAreNoInstances)
{
	RawlogWriter writer(folder_.file("a.rawlog"));
	writer.write(*makeScan());
	writer.close();
	EXPECT_THAT(run("a.rawlog").out, Not(HasSubstr("libsemloop-observations.so")));
}

TEST_F(SemloopRawlogInfo, TellsWhatIsOutOfOrder)
{
	RawlogWriter writer(folder_.file("a.rawlog"));
	for (const double time : {3, 1, 2})
	{
		mrpt::obs::CObservationOdometry odometry;
		odometry.timestamp = mrpt::Clock::fromDouble(time);
		writer.write(odometry);
	}
	writer.close();
	const auto result = run("a.rawlog");
	EXPECT_EQ(result.code, 0);
	EXPECT_THAT(
		result.out, HasSubstr("  (no label): 3 mrpt::obs::CObservationOdometry\n"
							  "    0.000 s to 2.000 s, 1.00 a second\n"
							  "    1 earlier than the one before\n"));
}

TEST_F(SemloopRawlogInfo, ObservationsWithoutATimeAreCounted)
{
	RawlogWriter writer(folder_.file("a.rawlog"));
	for (const double time : {1, 2, 3})
	{
		mrpt::obs::CObservationOdometry odometry;
		odometry.timestamp = time == 2 ? INVALID_TIMESTAMP : mrpt::Clock::fromDouble(time);
		writer.write(odometry);
	}
	writer.close();
	EXPECT_THAT(
		run("a.rawlog").out, HasSubstr("  (no label): 3 mrpt::obs::CObservationOdometry\n"
									   "    1 without a time\n"
									   "    0.000 s to 2.000 s, 0.50 a second\n"));
}

TEST_F(SemloopRawlogInfo, ACutFileEndsWithTheplaceAndWhatWasRead)
{
	RawlogWriter writer(folder_.file("a.rawlog"));
	for (int i = 0; i < 3; i++) writer.write(twoInstances(i + 1));
	writer.close();
	const std::string bytes = readBytes(folder_.file("a.rawlog"));
	folder_.write("a.rawlog", bytes.substr(0, bytes.size() - 20));
	const auto result = run("a.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("semloop-rawlog-info: a.rawlog: object "));
	EXPECT_THAT(result.err, HasSubstr("it was cut; what comes before can be used\n"));
	EXPECT_THAT(result.out, HasSubstr("semloop::CObservationInstances\n"));
}

TEST_F(SemloopRawlogInfo, MissingImagesAreAnError)
{
	fs::create_directories(folder_.path() / "a_Images");
	cv::imwrite(folder_.file("a_Images/c.png"), colorPattern({64, 48}));
	RawlogWriter writer(folder_.file("a.rawlog"));
	const auto scan = makeScan();
	scan->intensityImage.setExternalStorage("c.png");
	storeDepthExternally(*scan, folder_.file("a_Images"), "d.bin");
	writer.write(*scan);
	writer.close();
	const auto whole = run("--images a.rawlog");
	EXPECT_EQ(whole.code, 0) << whole.err;
	EXPECT_THAT(whole.out, HasSubstr("colour in files, depth in files"));

	fs::remove(folder_.path() / "a_Images/d.bin");
	const auto result = run("a.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("a_Images/d.bin: is missing; keep the folder of images"));
}

TEST_F(SemloopRawlogInfo, DamagedImagesAreFoundWhenAsked)
{
	fs::create_directories(folder_.path() / "a_Images");
	cv::imwrite(folder_.file("a_Images/c.png"), colorPattern({64, 48}));
	const std::string image = readBytes(folder_.file("a_Images/c.png"));
	folder_.write("a_Images/c.png", image.substr(0, image.size() / 2));
	RawlogWriter writer(folder_.file("a.rawlog"));
	const auto scan = makeScan();
	scan->intensityImage.setExternalStorage("c.png");
	writer.write(*scan);
	writer.close();
	EXPECT_EQ(run("a.rawlog").code, 0);
	const auto result = run("--images a.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("a_Images/c.png: the image is cut"));
}

TEST_F(SemloopRawlogInfo, AFileThatIsNoneIsAnError)
{
	folder_.write("a.rawlog", "This is not a rawlog.");
	EXPECT_EQ(run("a.rawlog").code, 1);
	const auto none = run("b.rawlog");
	EXPECT_EQ(none.code, 1);
	EXPECT_EQ(none.err, "semloop-rawlog-info: b.rawlog: no such file; correct the path\n");
	const auto plugin = run("-p ./none.so a.rawlog");
	EXPECT_EQ(plugin.code, 2);
	EXPECT_THAT(plugin.err, HasSubstr("--plugin = ./none.so: does not load"));
}

}  // namespace
