#include <gtest/gtest.h>
#include <semloop/observations/InstancePicture.h>
#include <semloop/observations/RawlogWriter.h>

#include <cstdint>
#include <filesystem>

#include "ChildProcess.h"
#include "MrptPrograms.h"
#include "TwoInstances.h"

namespace
{
using namespace semloop;

/** How many pixels of an X window dump (32 bits each, as Xvfb keeps them) have a colour. */
std::size_t pixelsOf(const std::string& dump, const mrpt::img::TColor& color)
{
	// Words of the header that count here; XWDFile.h has all of them.
	constexpr std::size_t kHeaderSize = 0, kWidth = 4, kHeight = 5, kBytesPerLine = 12,
						  kColors = 19;
	const auto word = [&](std::size_t index)
	{
		uint32_t value = 0;
		for (std::size_t i = 0; i < 4; i++) value = value << 8 | uint8_t(dump.at(4 * index + i));
		return std::size_t(value);
	};
	const std::size_t begin = word(kHeaderSize) + 12 * word(kColors);
	std::size_t count = 0;
	for (std::size_t y = 0; y < word(kHeight); y++)
		for (std::size_t x = 0; x < word(kWidth); x++)
		{
			const std::size_t at = begin + y * word(kBytesPerLine) + 4 * x;
			count += uint8_t(dump.at(at)) == color.B && uint8_t(dump.at(at + 1)) == color.G &&
					 uint8_t(dump.at(at + 2)) == color.R;
		}
	return count;
}

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
	const TemporaryFolder folder;
	RawlogWriter writer(folder.file("in.rawlog"));
	writer.write(wallOfPlants());
	writer.close();

	const std::string screen = folder.file("screen");
	ChildProcess viewer(
		{SEMLOOP_SOURCE_DIR "/tests/mrpt_programs/rawlogviewer.sh", folder.file("in.rawlog"),
		 SEMLOOP_BINARY_DIR "/lib/libsemloop-observations.so", screen},
		folder.file("out"), folder.file("err"));
	std::size_t seen = 0;
	while (viewer.isRunning())
	{
		std::this_thread::sleep_for(std::chrono::milliseconds(100));
		if (!std::filesystem::exists(screen)) continue;
		seen = pixelsOf(readBytes(screen), labelColor("potted plant"));
		if (seen >= 50) folder.write("screen.seen", "");
	}
	if (viewer.exitCode() == 77) GTEST_SKIP() << readBytes(folder.file("out"));
	EXPECT_GE(seen, 50u) << readBytes(folder.file("out")) << readBytes(folder.file("err"));
}
