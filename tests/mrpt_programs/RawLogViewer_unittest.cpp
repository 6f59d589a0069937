#include <gtest/gtest.h>
#include <semloop/observations/InstancePicture.h>
#include <semloop/observations/RawlogWriter.h>

#include <filesystem>

#include "ChildProcess.h"
#include "MrptPrograms.h"
#include "TwoInstances.h"
#include "XWindowDump.h"

namespace
{
using namespace semloop;

/** An observation whose one instance fills the image, so that it is easy to see. */
CObservationInstances wallOfPlants()
{
	auto observation = twoInstances(1000);
	observation.instances.pop_back();
	auto& plant = observation.instances.front();
	plant.box = {{0, 0}, observation.imageSize()};
	plant.mask = InstanceMask::encode(cv::Mat(plant.box.size(), CV_8UC1, cv::Scalar(255)));
	plant.depth = DepthCrop{cv::Mat(plant.box.size(), CV_16UC1, cv::Scalar(2000)), 0.001f};
	return observation;
}
}  // namespace

TEST(RawLogViewer, DrawsThePointsOfInstancesInTheirLabelsColour)
{
	const std::string whyNot = whyNotRunnable("RawLogViewer");
	if (!whyNot.empty()) GTEST_SKIP() << whyNot;
	for (const char* program : {"Xvfb", "xdotool"})
		if (!isInstalled(program)) GTEST_SKIP() << program << " is not installed";
	const TemporaryFolder folder;
	RawlogWriter writer(folder.file("in.rawlog"));
	writer.write(wallOfPlants());
	writer.close();

	std::filesystem::create_directory(folder.file("screen"));
	std::filesystem::create_directory(folder.file("home"));
	ChildProcess viewer(
		{SEMLOOP_SOURCE_DIR "/tests/common/on_xvfb.sh", folder.file("screen"),
		 SEMLOOP_SOURCE_DIR "/tests/mrpt_programs/rawlogviewer.sh", folder.file("in.rawlog"),
		 SEMLOOP_BINARY_DIR "/lib/libsemloop-observations.so", folder.file("home")},
		folder.file("out"), folder.file("err"));
	const mrpt::img::TColor color = labelColor("potted plant");
	const cv::Scalar wanted(color.B, color.G, color.R);
	int seen = 0;
	while (viewer.isRunning())
	{
		std::this_thread::sleep_for(std::chrono::milliseconds(100));
		const cv::Mat now = readXWindowDump(folder.file("screen/Xvfb_screen0"));
		if (now.empty()) continue;
		cv::Mat plant;
		cv::inRange(now, wanted, wanted, plant);
		seen = cv::countNonZero(plant);
		if (seen >= 50) folder.write("home/seen", "");
	}
	EXPECT_GE(seen, 50) << readBytes(folder.file("out")) << readBytes(folder.file("err"));
}
