#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/object_map/ObjectFiles.h>

#include <filesystem>
#include <map>
#include <sstream>

#include "../slam/SyntheticRun.h"
#include "MrptPrograms.h"

namespace semloop
{
namespace
{
using namespace synthetic;
namespace fs = std::filesystem;

/** Debian's observations2map, unmodified, on what a run of semloop-slam leaves. */
class Observations2Map : public testing::Test
{
protected:
	void SetUp() override
	{
		const std::string whyNot = whyNotRunnable("observations2map");
		if (!whyNot.empty()) GTEST_SKIP() << whyNot;
		RunOptions options;
		options.degrees = 120;
		const RecordedRun run = recordRun(folder_, options);
		const auto slam = shell(
			"'" SEMLOOP_BINARY_DIR "/bin/semloop-slam' -c '" SEMLOOP_SOURCE_DIR
			"/config_ini/recorded_odometry.ini' -i room.rawlog -o run --instances room.rawlog "
			"--set odometry.file=room_groundtruth.tum --set slam.scan_below=0.5",
			folder_.path());
		ASSERT_EQ(slam.code, 0) << slam.err;
		const auto maps = shell(
			"LD_PRELOAD='" SEMLOOP_BINARY_DIR
			"/lib/libsemloop-object_map.so' timeout 120 observations2map '" SEMLOOP_SOURCE_DIR
			"/config_ini/mrpt/observations2map.ini' run/map.simplemap maps",
			folder_.path());
		ASSERT_EQ(maps.code, 0) << maps.err;
	}

	/** The only file of the maps that has this in its name. */
	std::string file(const std::string& part) const
	{
		std::string found;
		for (const auto& entry : fs::directory_iterator(folder_.path()))
		{
			const std::string name = entry.path().filename().string();
			if (name.rfind("maps_", 0) != 0 || name.find(part) == std::string::npos) continue;
			EXPECT_EQ(found, "") << "two files with " << part;
			found = entry.path().string();
		}
		EXPECT_NE(found, "") << "no file with " << part;
		return found;
	}

	static std::map<uint32_t, int> labelsOf(const CObjectMap& map)
	{
		std::map<uint32_t, int> count;
		for (const auto& [id, object] : map.objects()) ++count[object.label()];
		return count;
	}

	TemporaryFolder folder_;
};

TEST_F(Observations2Map, MakesTheObjectsAndFillsMrptsMaps)
{
	const auto objects = loadObjectMap(file(".objmap"));
	const auto ofTheRun = loadObjectMap(folder_.file("run/map.objmap"));
	ASSERT_GE(ofTheRun->objects().size(), 4u);
	// From the key frames alone fewer objects are seen often enough.
	EXPECT_GE(objects->objects().size() + 2, ofTheRun->objects().size());
	for (const auto& [label, count] : labelsOf(*objects))
		EXPECT_GE(labelsOf(*ofTheRun)[label], 1) << label;

	// Points: x y z a line, all on or above the floor.
	const CPose3D T_truth_world =
		cameraOnCircle(0) + (-readTumTrajectory(folder_.file("run/trajectory.tum")).front().pose);
	std::istringstream points(readBytes(file("CSimplePointsMap")));
	std::size_t count = 0;
	for (TPoint3D p; points >> p.x >> p.y >> p.z; ++count)
		ASSERT_GT(T_truth_world.composePoint(p).z, -0.02);
	EXPECT_GT(count, 1000u);
	EXPECT_GT(fs::file_size(file("CColouredPointsMap")), 10000u);
	EXPECT_GT(fs::file_size(file("COctoMap_03_binary.bt")), 1000u);

	mrpt::io::CFileGZInputStream in(file(".gridmap"));
	mrpt::maps::COccupancyGridMap2D grid;
	mrpt::serialization::archiveFrom(in) >> grid;
	int occupied = 0, freeCells = 0;
	for (unsigned x = 0; x < grid.getSizeX(); ++x)
		for (unsigned y = 0; y < grid.getSizeY(); ++y)
		{
			occupied += grid.getCell(int(x), int(y)) < 0.4f;
			freeCells += grid.getCell(int(x), int(y)) > 0.6f;
		}
	EXPECT_GT(occupied, 10);
	EXPECT_GT(freeCells, 100);
}

}  // namespace
}  // namespace semloop
