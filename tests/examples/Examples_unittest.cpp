#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "../slam/SyntheticRun.h"
#include "Shell.h"

/** The plug-ins of doc/examples with an installed semloop-slam, as doc/examples/README.md says. */
namespace semloop
{
namespace
{
using namespace synthetic;
using testing::AllOf;
using testing::HasSubstr;

const std::string kExamples = SEMLOOP_BINARY_DIR "/examples/";

class Examples : public testing::Test
{
protected:
	Examples()
	{
		RunOptions options;
		options.degrees = 90;
		options.withInstances = false;
		recordRun(folder_, options);
	}

	ShellResult run(const std::string& more) const
	{
		return shell(
			"timeout 120 '" + kExamples +
				"prefix/bin/semloop-slam' -c mine.ini -i room.rawlog -o out " + more,
			folder_.path());
	}

	void writeConfiguration(const std::string& more) const
	{
		std::ofstream(folder_.file("mine.ini"))
			<< "[modules]\nplugins = " << kExamples << "color-segmenter/libcolor-segmenter.so, "
			<< kExamples << "coverage-map/libcoverage-map.so\n"
			<< "segmenter = examples::ColorSegmenter\nodometry = semloop::RecordedOdometry\n"
			<< "[odometry]\nfile = room_groundtruth.tum\n"
			<< "[slam]\nmin_observations = 3\n[tracking]\nmin_tracked_frames = 2\n"
			<< more;
	}

	TemporaryFolder folder_;
};

TEST_F(Examples, AForeignSegmenterAndAForeignMapWorkTogether)
{
	writeConfiguration(
		"[segmentation]\nmin_saturation = 60\n[semloop_map]\ncoverageMap_count = 1\n"
		"[semloop_map_coverageMap_00_creationOpts]\nresolution = 0.2\n");
	const auto result = run("");
	ASSERT_EQ(result.code, 0) << result.err;
	const std::string objects = readBytes(folder_.file("out/objects.json"));
	EXPECT_THAT(objects, AllOf(HasSubstr("red"), HasSubstr("green"), HasSubstr("cyan")));

	std::ifstream picture(folder_.file("out/maps/coverageMap_00.pgm"), std::ios::binary);
	std::string magic;
	int width = 0, height = 0, white = 0;
	picture >> magic >> width >> height >> white;
	EXPECT_EQ(magic, "P5");
	// 0.2 m a cell: the floor in front of a camera that goes a quarter round a room.
	EXPECT_GT(width, 15);
	EXPECT_GT(height, 15);
	picture.get();
	const std::string pixels{std::istreambuf_iterator<char>(picture), {}};
	ASSERT_EQ(pixels.size(), std::size_t(width * height));
	EXPECT_GT(std::count_if(pixels.begin(), pixels.end(), [](char c) { return c != 0; }), 50);
	EXPECT_TRUE(std::filesystem::exists(folder_.file("out/maps/coverageMap_00.metricmap")));
}

TEST_F(Examples, TheirOptionsAreAsStrictAsSemloopsOwn)
{
	writeConfiguration("[segmentation]\nmin_saturation = 256\n");
	const auto result = run("");
	EXPECT_EQ(result.code, 2);
	EXPECT_THAT(
		result.err,
		HasSubstr("[segmentation] min_saturation = 256: not allowed; use integer in [0, "
				  "255]"));
	writeConfiguration(
		"[semloop_map]\ncoverageMap_count = 1\n[semloop_map_coverageMap_00_creationOpts]\n"
		"resolution = 0\n");
	const auto noMap = run("");
	EXPECT_EQ(noMap.code, 2);
	EXPECT_THAT(noMap.err, HasSubstr("[semloop_map_coverageMap_00_...]: the map cannot be made"));
}

}  // namespace
}  // namespace semloop
