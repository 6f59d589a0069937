#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CFBORender.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <semloop/config/Error.h>
#include <semloop/object_map/CObjectMap.h>
#include <semloop/observations/CameraFrames.h>

#include "ObjectMapFixtures.h"

using namespace semloop;
using namespace semloop::synthetic;

namespace
{
/** T_world_robot of a robot that carries its camera like this, when the camera is there. */
CPose3D robotAt(const CPose3D& T_world_camera, const CPose3D& sensorPose)
{
	return T_world_camera + (-robotFromCamera(sensorPose));
}

const CPose3D kSensorPose(0.1, 0, 0.5, 0, 0.2, 0);
}  // namespace

TEST(CObjectMapMrpt, InsertingObservationsBuildsTheMapThatTheFrontEndBuilds)
{
	CObjectMap map;
	for (int place = 0; place < 8; ++place)
	{
		const View view = renderView(ballAndBox(), testCamera(), onCircle(place, 8));
		const auto observation = observationOf(view, {kCup, kBook}, kSensorPose);
		EXPECT_TRUE(map.insertObservation(observation, robotAt(onCircle(place, 8), kSensorPose)));
	}
	ASSERT_EQ(map.objects().size(), 2U);
	EXPECT_EQ(map.labels(), threeLabels());
	EXPECT_EQ(map.labelName(map.object(0)), "cup");
	EXPECT_EQ(map.object(0).covisible.count(1), 1U);
	EXPECT_GT(map.object(0).observations, 5);
	EXPECT_LT(map.object(0).centre().distanceTo({0, 0, 0.85}), 0.03);
	EXPECT_LT(map.object(1).centre().distanceTo({0, 0.45, 0.775}), 0.03);
}

TEST(CObjectMapMrpt, WithoutARobotPoseTheRobotStandsAtTheOrigin)
{
	const CPose3D T_world_camera = robotFromCamera(CPose3D(0, 0, 1, 0, 0, 0));
	Scene scene;
	scene.spheres.push_back({{1.5, 0.2, 1.0}, 0.2, {0, 0, 255}, 1, 0});
	const View view = renderView(scene, testCamera(), T_world_camera);
	CObjectMap map;
	ASSERT_TRUE(map.insertObservation(observationOf(view, {kCup}, CPose3D(0, 0, 1, 0, 0, 0))));
	EXPECT_LT(map.object(0).centre().distanceTo({1.5, 0.2, 1.0}), 0.2);
}

TEST(CObjectMapMrpt, TakesInstancesOutOfASensoryFrameAndLeavesOtherObservations)
{
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	mrpt::obs::CSensoryFrame frame;
	frame.insert(mrpt::obs::CObservationOdometry::Create());
	auto instances =
		std::make_shared<CObservationInstances>(observationOf(view, {kCup, kBook}, kSensorPose));
	frame.insert(instances);
	CObjectMap map;
	const CPose3D robot = robotAt(onCircle(0, 8), kSensorPose);
	EXPECT_TRUE(frame.insertObservationsInto(map, robot));
	EXPECT_EQ(map.objects().size(), 2U);
	EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationOdometry()));
	EXPECT_TRUE(map.canComputeObservationsLikelihood(frame));
	EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationOdometry()));
}

TEST(CObjectMapMrpt, InstancesWithoutDepthCropsOrOfOtherLabelsAreNotInserted)
{
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	auto observation = observationOf(view, {kCup, kBook}, kSensorPose);
	CObjectMap map;
	ASSERT_TRUE(map.insertObservation(observation));
	observation.labels = LabelSet::coco();
	EXPECT_THROW(map.insertObservation(observation), InputError);
	map.clear();
	EXPECT_TRUE(map.isEmpty());
	for (auto& instance : observation.instances) instance.depth.reset();
	EXPECT_FALSE(map.insertObservation(observation));
	EXPECT_FALSE(map.insertObservation(CObservationInstances(observation)));
	EXPECT_TRUE(map.isEmpty());
}

TEST(CObjectMapMrpt, TheLikelihoodIsHighestWhereTheObservationWasTaken)
{
	const CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	const CPose3D truth = robotAt(onCircle(1, 8), kSensorPose);
	const auto observation = observationOf(
		renderView(ballAndBox(), testCamera(), onCircle(1, 8)), {kCup, kBook}, kSensorPose);
	const double best = map.computeObservationLikelihood(observation, truth);
	EXPECT_LT(best, 0);
	for (const CPose3D& error :
		 {CPose3D(0.1, 0, 0, 0, 0, 0), CPose3D(0, 0.1, 0, 0, 0, 0), CPose3D(0, 0, 0, 0.1, 0, 0)})
		EXPECT_LT(map.computeObservationLikelihood(observation, truth + error), best - 0.1);
	// Next to nothing explained: about log(0.1) for each of the two.
	const CPose3D away = truth + CPose3D(0, 0, 0, M_PI, 0, 0);
	EXPECT_NEAR(map.computeObservationLikelihood(observation, away), 2 * std::log(0.1), 0.3);
	EXPECT_NEAR(
		CObjectMap().computeObservationLikelihood(observation, truth), 2 * std::log(0.1), 1e-9);
}

TEST(CObjectMapMrpt, SerialisationBringsBackTheSameMap)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	map.insertionOptions.maxDepth = 3.25;
	map.maintenanceOptions.mergeIou = 0.45;
	map.markCovisible({0, 1});
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	map.fuse(
		0, view.frame, makeInstance(view.masks[1], kChair, 0.7f, {0.6f, 0.8f}), onCircle(0, 8));
	const std::string bytes = bytesOf(map);

	mrpt::io::CMemoryStream stream;
	auto archive = mrpt::serialization::archiveFrom(stream);
	archive << map;
	stream.Seek(0);
	CObjectMap back;
	archive >> back;
	EXPECT_EQ(bytesOf(back), bytes);
	EXPECT_EQ(back.labels(), map.labels());
	EXPECT_EQ(back.insertionOptions.maxDepth, 3.25);
	EXPECT_EQ(back.maintenanceOptions.mergeIou, 0.45);
	ASSERT_EQ(back.objects().size(), 2U);
	EXPECT_EQ(back.object(0).labelScores, map.object(0).labelScores);
	EXPECT_EQ(back.object(0).embeddings, map.object(0).embeddings);
	EXPECT_EQ(back.object(0).covisible, map.object(0).covisible);
	EXPECT_EQ(back.object(0).existence, map.object(0).existence);
	EXPECT_EQ(back.object(0).lastSeen, map.object(0).lastSeen);
	EXPECT_EQ(back.object(1).extent(), map.object(1).extent());
	// It goes on as the original does.
	EXPECT_EQ(
		back.addObject(view.frame, makeInstance(view.masks[2], kBook), onCircle(0, 8)),
		map.addObject(view.frame, makeInstance(view.masks[2], kBook), onCircle(0, 8)));
	EXPECT_EQ(bytesOf(back), bytesOf(map));
}

TEST(CObjectMapMrpt, ComposesIntoAMultiMetricMapFromAnIniFile)
{
	mrpt::config::CConfigFileMemory ini;
	ini.setContent(
		std::string("[map]\nobjectMap_count=1\n[map_objectMap_00_insertOpts]\nmax_depth=2.5\n"
					"[map_objectMap_00_maintenanceOpts]\nmerge_iou=0.6\n"));
	mrpt::maps::TSetOfMetricMapInitializers definitions;
	definitions.loadFromConfigFile(ini, "map");
	mrpt::maps::CMultiMetricMap maps;
	maps.setListOfMaps(definitions);
	const auto map = maps.mapByClass<CObjectMap>();
	ASSERT_TRUE(map);
	EXPECT_EQ(map->insertionOptions.maxDepth, 2.5);
	EXPECT_EQ(map->maintenanceOptions.mergeIou, 0.6);
}

TEST(CObjectMapMrpt, AnUnknownKeyInTheIniFileStops)
{
	mrpt::config::CConfigFileMemory ini;
	ini.write("map_objectMap_00_insertOpts", "max_deth", 3.0);
	CObjectMap::TMapDefinition definition;
	EXPECT_THROW(definition.loadFromConfigFile(ini, "map_objectMap_00"), UsageError);
}

TEST(CObjectMapMrpt, AnEmptyMapDoesEverything)
{
	CObjectMap map;
	EXPECT_TRUE(map.isEmpty());
	EXPECT_TRUE(map.predict(testCamera(), CPose3D()).empty());
	EXPECT_TRUE(map.findDuplicates().empty());
	EXPECT_TRUE(map.removeUnsupported().empty());
	EXPECT_NO_THROW(map.updateExistence({}, RgbdFrame(), {}));
	EXPECT_NO_THROW(map.moveObjects({}));
	EXPECT_EQ(map.asString(), "CObjectMap: 0 objects of 0 labels, 0 KiB");
	mrpt::opengl::CSetOfObjects drawn;
	map.getVisualizationInto(drawn);
	EXPECT_EQ(drawn.size(), 0U);
	map.clear();
	CObjectMap back;
	mrpt::io::CMemoryStream stream;
	auto archive = mrpt::serialization::archiveFrom(stream);
	archive << map;
	stream.Seek(0);
	archive >> back;
	EXPECT_TRUE(back.isEmpty());
	EXPECT_FALSE(map.insertObservation(CObservationInstances()));
}

TEST(CObjectMapMrpt, DrawsObjectsThatARendererSees)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	map.markCovisible({0, 1});
	auto scene = mrpt::opengl::COpenGLScene::Create();
	auto all = mrpt::opengl::CSetOfObjects::Create();
	map.getVisualizationInto(*all);
	EXPECT_EQ(all->size(), 3U);  // two objects and the edges
	scene->insert(all);

	mrpt::opengl::CFBORender renderer(320, 240);
	auto& camera = renderer.getCamera(*scene);
	camera.setPointingAt(0, 0.2f, 0.8f);
	camera.setZoomDistance(1.5f);
	camera.setAzimuthDegrees(0);
	camera.setElevationDegrees(30);
	mrpt::img::CImage image(320, 240, mrpt::img::CH_RGB);
	renderer.render_RGB(*scene, image);
	int reddish = 0, bluish = 0;
	const cv::Mat pixels = image.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY);
	for (int v = 0; v < pixels.rows; ++v)
		for (int u = 0; u < pixels.cols; ++u)
		{
			const auto& c = pixels.at<cv::Vec3b>(v, u);
			reddish += c[2] > 2 * c[0] && c[2] > 60;
			bluish += c[0] > 2 * c[2] && c[0] > 60;
		}
	EXPECT_GT(reddish, 500);  // the ball
	EXPECT_GT(bluish, 500);   // the box
}

TEST(CObjectMapMrpt, AFrameAndItsInstancesInAnyOrderBuildTheMapWithoutDepthCrops)
{
	for (const bool scanFirst : {true, false})
	{
		CObjectMap map;
		for (int place = 0; place < 8; ++place)
		{
			const View view = renderView(ballAndBox(), testCamera(), onCircle(place, 8));
			auto instances = observationOf(view, {kCup, kBook}, kSensorPose);
			for (auto& instance : instances.instances) instance.depth.reset();
			const auto scan = scanOf(view, instances);
			const CPose3D robot = robotAt(onCircle(place, 8), kSensorPose);
			if (scanFirst)
				EXPECT_FALSE(map.insertObservation(scan, robot));
			else
				EXPECT_FALSE(map.insertObservation(instances, robot));
			if (scanFirst)
				EXPECT_TRUE(map.insertObservation(instances, robot));
			else
				EXPECT_TRUE(map.insertObservation(scan, robot));
		}
		ASSERT_EQ(map.objects().size(), 2U);
		EXPECT_LT(map.object(0).centre().distanceTo({0, 0, 0.85}), 0.03);
		EXPECT_LT(map.object(1).centre().distanceTo({0, 0.45, 0.775}), 0.03);
	}
}

TEST(CObjectMapMrpt, WithTwoCamerasInstancesGoWithTheScanOfTheirOwn)
{
	// Two cameras of one robot, which both images come from at once.
	const CPose3D places[] = {onCircle(0, 8), onCircle(1, 8)};
	const CPose3D robot(0.1, 0.2, 0, 0.3, 0, 0);
	std::vector<CObservationInstances> instances;
	std::vector<mrpt::obs::CObservation3DRangeScan> scans;
	for (const auto& place : places)
	{
		const View view = renderView(ballAndBox(), testCamera(), place);
		const CPose3D sensorPose = (-robot) + place + (-sensorFromCamera());
		instances.push_back(observationOf(view, {kCup, kBook}, sensorPose));
		for (auto& instance : instances.back().instances) instance.depth.reset();
		scans.push_back(scanOf(view, instances.back()));
	}
	CObjectMap map;
	for (const auto& scan : scans) EXPECT_FALSE(map.insertObservation(scan, robot));
	EXPECT_TRUE(map.insertObservation(instances[0], robot));
	EXPECT_TRUE(map.insertObservation(instances[1], robot));
	ASSERT_EQ(map.objects().size(), 2U);
	EXPECT_EQ(map.object(0).observations, 2);
	EXPECT_EQ(map.object(1).observations, 2);
	// Seen from one side.
	EXPECT_LT(map.object(0).centre().distanceTo({0, 0, 0.85}), 0.08);
	EXPECT_LT(map.object(1).centre().distanceTo({0, 0.45, 0.775}), 0.08);
}

TEST(CObjectMapMrpt, AScanOfAnotherTimeIsNotTheInstances)
{
	const View view = renderView(ballAndBox(), testCamera(), onCircle(0, 8));
	auto instances = observationOf(view, {kCup, kBook}, kSensorPose);
	for (auto& instance : instances.instances) instance.depth.reset();
	auto scan = scanOf(view, instances);
	scan.timestamp += std::chrono::milliseconds(33);
	CObjectMap map;
	EXPECT_FALSE(map.insertObservation(scan));
	EXPECT_FALSE(map.insertObservation(instances));
	EXPECT_TRUE(map.isEmpty());
}

TEST(CObjectMapMrpt, EachPartOfThePictureCanBeSwitchedOff)
{
	CObjectMap map = mapOf(ballAndBox(), {kCup, kBook});
	map.markCovisible({0, 1});
	const auto parts = [&]
	{
		mrpt::opengl::CSetOfObjects all;
		map.getVisualizationInto(all);
		std::map<std::string, int> count;
		for (const auto& object : all)
		{
			const auto group = std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(object);
			if (!group) ++count[object->GetRuntimeClass()->className];
			if (group)
				for (const auto& part : *group) ++count[part->GetRuntimeClass()->className];
		}
		return count;
	};
	using Parts = std::map<std::string, int>;
	const Parts all{
		{"mrpt::opengl::CBox", 2},
		{"mrpt::opengl::CSetOfLines", 1},
		{"mrpt::opengl::CSetOfTriangles", 2},
		{"mrpt::opengl::CText", 2}};
	EXPECT_EQ(parts(), all);
	map.visualizationOptions.meshes = map.visualizationOptions.names = false;
	EXPECT_EQ(parts(), (Parts{{"mrpt::opengl::CBox", 2}, {"mrpt::opengl::CSetOfLines", 1}}));
	map.visualizationOptions.boxes = map.visualizationOptions.edges = false;
	EXPECT_EQ(parts(), Parts());
	map.visualizationOptions = {};
	map.genericMapParams.enableSaveAs3DObject = false;
	EXPECT_EQ(parts(), Parts());
}
