#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semloop/simulation/ColorSensor.h>
#include <semloop/simulation/DepthSensor.h>
#include <semloop/simulation/OdometryNoise.h>
#include <semloop/simulation/SceneDescription.h>
#include <semloop/simulation/SimulatedDetector.h>

#include "TemporaryFolder.h"

using namespace semloop;

TEST(SimulationManual, ItsTablesAreTheOptions)
{
	const auto page = readBytes(SEMLOOP_SOURCE_DIR "/doc/simulation.md");
	const auto expectTable = [&](const std::string& section, const Options& options) {
		EXPECT_THAT(page, testing::HasSubstr(section + "\n\n" + options.markdownTable()));
	};
	expectTable("### `[scene]`", SceneOptions());
	expectTable("### `[room.NAME]`", RoomOptions());
	expectTable("### `[path]`", PathOptions());
	expectTable("### `[camera]`", CameraOptions());
	expectTable("### A section of the models file", ItemOptions());
	expectTable("### `[depth_sensor]`", DepthSensorOptions());
	expectTable("### `[color_sensor]`", ColorSensorOptions());
	expectTable("### `[detector]`", SimulatedDetectorOptions());
	expectTable("### `[odometry]`", OdometryNoiseOptions());
}
