#pragma once

#include <semloop/observations/CObservationInstances.h>

#include <opencv2/core.hpp>

namespace semloop
{
/** A potted plant of 8 x 6 pixels at (10, 20), 2 m away, and a mug of 3 x 2 at (40, 5) without depth, in an
 *  image of 64 x 48. */
inline CObservationInstances twoInstances(double seconds)
{
	CObservationInstances o;
	o.timestamp = mrpt::Clock::fromDouble(seconds);
	o.sensorLabel = "instances";
	o.camera.ncols = 64;
	o.camera.nrows = 48;
	o.camera.setIntrinsicParamsFromValues(52, 52, 31.5, 23.5);
	o.labels = LabelSet({"potted plant", "mug"});

	Instance plant;
	plant.box = {10, 20, 8, 6};
	plant.mask = InstanceMask::encode(
		cv::Mat(plant.box.size(), CV_8UC1, cv::Scalar(255)), plant.box.tl(), o.imageSize());
	plant.labelScores = {{0, 0.75f}, {1, 0.25f}};
	plant.confidence = 0.5f;
	plant.embedding = {0.6f, 0.8f};
	plant.depth = DepthCrop{cv::Mat(plant.box.size(), CV_16UC1, cv::Scalar(2000)), 0.001f};

	Instance mug;
	mug.box = {40, 5, 3, 2};
	mug.mask = InstanceMask::encode(
		cv::Mat(mug.box.size(), CV_8UC1, cv::Scalar(255)), mug.box.tl(), o.imageSize());
	mug.labelScores = {{1, 1.0f}};
	mug.confidence = 1;
	o.instances = {plant, mug};
	return o;
}

}  // namespace semloop
