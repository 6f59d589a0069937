#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/COccupancyGridMap3D.h>
#include <mrpt/maps/COctoMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/slam/Configuration.h>
#include <semloop/slam/FrameSource.h>
#include <semloop/slam/OtherMaps.h>
#include <semloop/slam/RunResults.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "SyntheticRun.h"

namespace semloop
{
namespace
{
using namespace synthetic;
using mrpt::config::CConfigFileMemory;
using ::testing::AllOf;
using ::testing::HasSubstr;

/** A mapped room, true poses but for the drift. */
struct Room
{
	explicit Room(double drift = 0, double degrees = 360)
	{
		RunOptions options;
		options.degrees = degrees;
		const RecordedRun recorded = recordRun(folder, options);
		config = runConfiguration(recorded, drift);
		config.write("slam", "scan_below", 0.5);
		config.write("slam", "scan_above", 0.2);
		logger.logging_enable_console_output = false;
		slam = std::make_unique<SemanticSlam>(config, logger, timings);
		FrontEnd front = makeFrontEnd(config);
		FrameSource source(std::make_unique<RawlogReader>(recorded.rawlog), front, 2, timings);
		while (auto frame = source.next()) slam->process(*frame);
		slam->finish();
		T_truth_world = cameraOnCircle(0) + (-slam->trajectory().front().pose);
	}

	mrpt::maps::CMultiMetricMap::Ptr maps(const CConfigFileMemory& definition) const
	{
		return OtherMaps(definition).build(*slam);
	}

	TemporaryFolder folder;
	CConfigFileMemory config;
	mrpt::system::COutputLogger logger;
	StageTimings timings;
	std::unique_ptr<SemanticSlam> slam;
	CPose3D T_truth_world;
};

double distanceToBox(const Box& box, const TPoint3D& at)
{
	const TPoint3D p = box.T_world_box.inverseComposePoint(at);
	const double dx = std::abs(p.x) - box.size.x / 2, dy = std::abs(p.y) - box.size.y / 2,
				 dz = std::abs(p.z) - box.size.z / 2;
	const double outside = std::hypot(std::max(dx, 0.0), std::max(dy, 0.0), std::max(dz, 0.0));
	return std::abs(outside + std::min(0.0, std::max({dx, dy, dz})));
}

double distanceToSurface(const Scene& scene, const TPoint3D& at)
{
	double nearest = std::abs(at.z);  // the floor
	for (const auto& s : scene.spheres)
		nearest = std::min(nearest, std::abs((at - s.centre).norm() - s.radius));
	for (const auto& box : scene.boxes) nearest = std::min(nearest, distanceToBox(box, at));
	return nearest;
}

double meanDistanceToSurfaces(const mrpt::maps::CPointsMap& points, const CPose3D& T_truth_world)
{
	const Scene scene = roomScene(RunOptions().objects);
	double sum = 0;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		TPoint3D p;
		points.getPoint(i, p.x, p.y, p.z);
		sum += distanceToSurface(scene, T_truth_world.composePoint(p));
	}
	return sum / double(points.size());
}

CConfigFileMemory definition(const std::string& text)
{
	return CConfigFileMemory("[semloop_map]\n" + text);
}

const char* const kPoints =
	"pointsMap_count = 1\n"
	"[semloop_map_pointsMap_00_insertOpts]\nminDistBetweenLaserPoints = 0.05\n";

std::string bytesOf(const mrpt::maps::CMetricMap& map)
{
	mrpt::io::CMemoryStream stream;
	mrpt::serialization::archiveFrom(stream) << map;
	return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

void expectUsageError(const CConfigFileMemory& config, const ::testing::Matcher<std::string>& what)
{
	try
	{
		OtherMaps maps(config);
		FAIL() << "no error";
	}
	catch (const UsageError& e)
	{
		EXPECT_THAT(std::string(e.what()), what);
	}
}
}  // namespace

TEST(OtherMaps, PointsLieOnTheSurfacesOfTheRoom)
{
	const Room room;
	const auto maps = room.maps(definition(kPoints));
	const auto points = maps->mapByClass<mrpt::maps::CSimplePointsMap>();
	ASSERT_GT(points->size(), 2000u);
	EXPECT_LT(meanDistanceToSurfaces(*points, room.T_truth_world), 0.01);
}

TEST(OtherMaps, AreMadeFromTheOptimisedPosesNotTheOdometrys)
{
	const Room room(0.8, 450);
	const auto maps = room.maps(definition(kPoints));
	const auto points = maps->mapByClass<mrpt::maps::CSimplePointsMap>();
	// The same with the poses of the odometry, which nothing has corrected.
	mrpt::maps::CSimplePointsMap drifted;
	drifted.insertionOptions.minDistBetweenLaserPoints = 0.05f;
	for (const auto& key : room.slam->keyFrames())
	{
		mrpt::obs::CObservation3DRangeScan scan = *key.scan;
		mrpt::obs::T3DPointsProjectionParams sensorFrame;
		sensorFrame.takeIntoAccountSensorPoseOnRobot = false;
		scan.load();
		scan.unprojectInto(scan, sensorFrame);
		drifted.insertObservation(
			scan, room.slam->odometryTrajectory()[key.frame].pose + (-sensorFromCamera()));
	}
	EXPECT_LT(
		meanDistanceToSurfaces(*points, room.T_truth_world),
		0.6 * meanDistanceToSurfaces(drifted, room.T_truth_world));
}

TEST(OtherMaps, AnOccupancyGridIsFreeWhereTheCameraWasAndOccupiedAtObjects)
{
	const Room room;
	const auto maps =
		room.maps(definition("occupancyGrid_count = 1\n"
							 "[semloop_map_occupancyGrid_00_creationOpts]\nresolution = 0.05\n"));
	const auto grid = maps->mapByClass<mrpt::maps::COccupancyGridMap2D>();
	ASSERT_TRUE(grid);
	const auto occupied = [&](const TPoint3D& truth)
	{
		const auto p = room.T_truth_world.inverseComposePoint(truth);
		float least = 1;
		for (double dx = -0.1; dx <= 0.1; dx += 0.05)
			for (double dy = -0.1; dy <= 0.1; dy += 0.05)
				least = std::min(least, grid->getPos(float(p.x + dx), float(p.y + dy)));
		return least < 0.4f;
	};
	for (int degrees = 0; degrees < 360; degrees += 30)
	{
		const auto p =
			room.T_truth_world.inverseComposePoint(cameraOnCircle(degrees).translation());
		EXPECT_GT(grid->getPos(float(p.x), float(p.y)), 0.5f) << degrees;
	}
	int inSlice = 0;
	for (const auto& sphere : roomScene(RunOptions().objects).spheres)
	{
		if (sphere.centre.z < 0.8 || sphere.centre.z > 1.3) continue;
		++inSlice;
		const double r = std::hypot(sphere.centre.x, sphere.centre.y), to = (r - sphere.radius) / r;
		EXPECT_TRUE(occupied({sphere.centre.x * to, sphere.centre.y * to, 1.2})) << sphere.id;
	}
	EXPECT_GE(inSlice, 3);
}

TEST(OtherMaps, AHorizontalScanIsTheNearestOfItsKeyFramesPoints)
{
	const Room room(0, 60);
	writeRunResults(room.folder.path().string(), *room.slam, RunInfo(), room.timings);
	mrpt::maps::CSimpleMap keyFrames;
	ASSERT_TRUE(keyFrames.loadFromFile(room.folder.file("map.simplemap")));
	ASSERT_EQ(keyFrames.size(), room.slam->keyFrames().size());
	const Scene scene = roomScene(RunOptions().objects);
	int rays = 0;
	for (std::size_t i = 0; i < keyFrames.size(); ++i)
	{
		mrpt::poses::CPose3DPDF::Ptr pose;
		mrpt::obs::CSensoryFrame::Ptr frame;
		keyFrames.get(i, pose, frame);
		const auto scan = frame->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
		const auto points = frame->getObservationByClass<mrpt::obs::CObservation3DRangeScan>();
		const double step = scan->aperture / double(scan->getScanSize() - 1);
		const auto angle = [&](std::size_t ray) { return double(ray) * step - scan->aperture / 2; };
		for (std::size_t ray = 0; ray < scan->getScanSize(); ++ray)
		{
			if (!scan->getScanRangeValidity(ray)) continue;
			++rays;
			const double range = scan->getScanRange(ray);
			// Level: somewhere between scan_below and scan_above this direction meets something.
			const CPose3D T_truth_scan = room.T_truth_world + pose->getMeanVal() + scan->sensorPose;
			double nearest = 1;
			for (double z = -0.5; z <= 0.2; z += 0.01)
				nearest = std::min(
					nearest, distanceToSurface(
								 scene, T_truth_scan.composePoint(TPoint3D(
											range * std::cos(angle(ray)),
											range * std::sin(angle(ray)), z))));
			EXPECT_LT(nearest, 0.03) << "key frame " << i << ", ray " << ray;
		}
		const CPose3D T_scan_camera = (-scan->sensorPose) + points->sensorPose;
		for (std::size_t k = 0; k < points->points3D_x.size(); ++k)
		{
			const auto p = T_scan_camera.composePoint(
				TPoint3D(points->points3D_x[k], points->points3D_y[k], points->points3D_z[k]));
			if (p.z < -0.5 || p.z > 0.2) continue;
			const auto ray = std::lround((std::atan2(p.y, p.x) + scan->aperture / 2) / step);
			// A tilted camera sees further to the sides than a level one.
			if (ray < 0 || ray >= long(scan->getScanSize())) continue;
			ASSERT_TRUE(scan->getScanRangeValidity(ray));
			EXPECT_LE(scan->getScanRange(ray), std::hypot(p.x, p.y) + 1e-5);
		}
	}
	EXPECT_GT(rays, 200);
}

TEST(OtherMaps, EveryKindThatTakesPointsOrScansIsFilledAndSaved)
{
	const Room room(0, 100);
	const OtherMaps other(
		definition("pointsMap_count = 2\ncolourPointsMap_count = 1\noctoMap_count = 1\n"
				   "COccupancyGridMap3D_count = 1\noccupancyGrid_count = 1\nobjectMap_count = 1\n"
				   "[semloop_map_objectMap_00_insertOpts]\nmax_depth = 5\n"));
	const auto maps = other.build(*room.slam);
	ASSERT_EQ(maps->maps.size(), other.names().size());
	for (std::size_t i = 0; i < maps->maps.size(); ++i)
		EXPECT_FALSE(maps->maps[i]->isEmpty()) << other.names()[i];

	const std::string folder = room.folder.file("maps");
	writeOtherMaps(folder, other.names(), *maps);
	for (const char* file :
		 {"pointsMap_00.txt", "pointsMap_01.txt", "colourPointsMap_00.txt", "octoMap_00_binary.bt",
		  "COccupancyGridMap3D_00.metricmap", "occupancyGrid_00.gridmap", "objectMap_00.objmap",
		  "maps.3Dscene"})
		EXPECT_TRUE(std::filesystem::exists(folder + "/" + file)) << file;

	mrpt::io::CFileGZInputStream in(folder + "/occupancyGrid_00.gridmap");
	mrpt::maps::COccupancyGridMap2D grid;
	mrpt::serialization::archiveFrom(in) >> grid;
	const auto original = maps->mapByClass<mrpt::maps::COccupancyGridMap2D>();
	EXPECT_EQ(grid.getSizeX(), original->getSizeX());
	EXPECT_EQ(grid.getRawMap(), original->getRawMap());

	writeOtherMaps(folder, {}, mrpt::maps::CMultiMetricMap());
	EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(OtherMaps, AMapIsTheSameAloneAndBesideOthers)
{
	const Room room(0, 100);
	const std::vector<std::string> kinds = {"COccupancyGridMap3D", "colourPointsMap", "objectMap",
											"occupancyGrid",       "octoMap",         "pointsMap"};
	std::string all;
	for (const auto& kind : kinds) all += kind + "_count = 1\n";
	const OtherMaps together(definition(all));
	const auto maps = together.build(*room.slam);
	for (const auto& kind : kinds)
	{
		const auto alone = room.maps(definition(kind + "_count = 1\n"));
		const auto& names = together.names();
		const auto at = std::find(names.begin(), names.end(), kind + "_00") - names.begin();
		EXPECT_TRUE(bytesOf(*maps->maps[std::size_t(at)]) == bytesOf(*alone->maps[0])) << kind;
	}
}

TEST(OtherMaps, NothingIsRemovedThatNoRunWrote)
{
	const TemporaryFolder folder;
	std::filesystem::create_directories(folder.file("maps"));
	std::ofstream(folder.file("maps/mine.txt")) << "mine";
	writeOtherMaps(folder.file("maps"), {}, mrpt::maps::CMultiMetricMap());
	EXPECT_TRUE(std::filesystem::exists(folder.file("maps/mine.txt")));
}

TEST(OtherMaps, WhatMrptWouldPassOverInSilenceIsAnError)
{
	EXPECT_TRUE(OtherMaps(CConfigFileMemory("[slam]\n")).empty());
	expectUsageError(
		definition("pointMap_count = 1\n"),
		AllOf(HasSubstr("pointMap_count: no map 'pointMap'"), HasSubstr("pointsMap")));
	expectUsageError(definition("pointsMap = 1\n"), HasSubstr("pointsMap: unknown key"));
	expectUsageError(definition("pointsMap_count = some\n"), HasSubstr("not allowed"));
	expectUsageError(
		definition("pointsMap_count = 1\n[semloop_map_pointsMap_01_insertOpts]\nx = 1\n"),
		HasSubstr("[semloop_map_pointsMap_01_insertOpts]: there is no such map"));
	expectUsageError(
		definition(
			"occupancyGrid_count = 1\n[semloop_map_occupancyGrid_00_creationOpts]\nresolution=0\n"),
		AllOf(
			HasSubstr("semloop_map_occupancyGrid_00"), HasSubstr("cannot be made of its options")));
}
}  // namespace semloop
