#pragma once

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/object_map/CObjectMap.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "SyntheticScene.h"

namespace semloop::synthetic
{
constexpr uint32_t kCup = 0, kBook = 1, kChair = 2;

inline LabelSet threeLabels()
{
	return LabelSet({"cup", "book", "dining chair"});
}

inline CObjectMap emptyMap()
{
	CObjectMap map;
	map.setLabels(threeLabels());
	return map;
}

inline mrpt::img::TCamera testCamera()
{
	return makeCamera(320, 240, 262.5);
}

/** A ball of 0.3 m (object 1) and a box of 0.3 x 0.2 x 0.15 m (object 2) on a table 0.7 m high. */
inline Scene ballAndBox()
{
	Scene scene;
	scene.boxes.push_back(tableAt(0.7));
	scene.spheres.push_back({{0, 0, 0.85}, 0.15, {40, 40, 220}, 1, 0});
	scene.boxes.push_back(
		{CPose3D(0, 0.45, 0.775, 0, 0, 0), {0.3, 0.2, 0.15}, {220, 90, 40}, 2, 0});
	return scene;
}

/** Camera number `index` of `count` on a circle round the table, looking at its middle. */
inline CPose3D onCircle(int index, int count, const TPoint3D& target = {0, 0, 0.8})
{
	const double angle = 2 * M_PI * index / count;
	return lookAt({1.3 * std::cos(angle), 1.3 * std::sin(angle), 1.3}, target);
}

/** The whole scene, object i from id i, seen from eight sides. Ids in the map: id - 1. */
inline CObjectMap mapOf(const Scene& scene, const std::vector<uint32_t>& labels)
{
	CObjectMap map = emptyMap();
	for (int view = 0; view < 8; ++view)
	{
		const CPose3D T_world_camera = onCircle(view, 8);
		View seen = renderView(scene, testCamera(), T_world_camera);
		seen.frame.time = mrpt::Clock::fromDouble(100.0 + view);
		for (std::size_t id = 1; id < seen.masks.size(); ++id)
		{
			const Instance instance = makeInstance(seen.masks[id], labels.at(id - 1));
			if (view == 0)
				map.addObject(seen.frame, instance, T_world_camera);
			else
				map.fuse(id - 1, seen.frame, instance, T_world_camera);
		}
	}
	return map;
}

inline std::string bytesOf(const CObjectMap& map)
{
	mrpt::io::CMemoryStream stream;
	mrpt::serialization::archiveFrom(stream) << map;
	return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

/** The scene's instances with depth crops, as an observation of a sensor with this pose on the robot. */
inline CObservationInstances observationOf(
	const View& view, const std::vector<uint32_t>& labels, const CPose3D& sensorPose)
{
	CObservationInstances observation;
	observation.camera = view.frame.camera;
	observation.sensorPose = sensorPose;
	observation.labels = threeLabels();
	observation.timestamp = mrpt::Clock::fromDouble(200.0);
	for (std::size_t id = 1; id < view.masks.size(); ++id)
	{
		if (view.masks[id].empty()) continue;
		Instance instance = makeInstance(view.masks[id], labels.at(id - 1), 0.9f);
		DepthCrop crop;
		view.frame.depth(instance.box).convertTo(crop.depth, CV_16UC1, 1000);
		instance.depth = crop;
		observation.instances.push_back(instance);
	}
	return observation;
}

/** The range scan that the instances were found in. */
inline mrpt::obs::CObservation3DRangeScan scanOf(
	const View& view, const CObservationInstances& instances)
{
	mrpt::obs::CObservation3DRangeScan scan;
	scan.timestamp = instances.timestamp;
	scan.sensorPose = instances.sensorPose;
	scan.cameraParams = scan.cameraParamsIntensity = instances.camera;
	scan.hasIntensityImage = scan.hasRangeImage = true;
	scan.intensityImage = mrpt::img::CImage(view.frame.color, mrpt::img::DEEP_COPY);
	scan.rangeUnits = 0.001f;
	scan.rangeImage_setSize(view.frame.depth.rows, view.frame.depth.cols);
	for (int row = 0; row < view.frame.depth.rows; ++row)
		for (int column = 0; column < view.frame.depth.cols; ++column)
			scan.rangeImage(row, column) =
				uint16_t(std::lround(1000 * view.frame.depth.at<float>(row, column)));
	return scan;
}

}  // namespace semloop::synthetic
