#pragma once

#include <semloop/observations/CObservationInstances.h>
#include <semloop/simulation/Scene.h>
#include <semloop/simulation/SimulatedDetector.h>

#include <string>
#include <vector>

#include "HandMadeView.h"

namespace semloop
{
constexpr uint32_t kChair = 0, kCouch = 1, kTable = 2;

/** Objects of these labels, each of a model of its own, at the origin. */
inline Scene sceneOf(const std::vector<uint32_t>& labels)
{
	Scene scene;
	scene.name = "test";
	scene.labels = LabelSet({"chair", "couch", "dining table"});
	for (const uint32_t label : labels)
	{
		SceneObject object;
		object.id = uint32_t(scene.objects.size() + 1);
		object.label = label;
		object.model = "model" + std::to_string(object.id);
		scene.objects.push_back(object);
	}
	return scene;
}

/** A view of 640 x 480 in which object i + 1 covers box i. */
inline RenderedView viewOf(const std::vector<cv::Rect>& boxes)
{
	RenderedView view = wallView(640, 480, 3.0F);
	for (std::size_t i = 0; i < boxes.size(); i++)
		view.object(boxes[i]) = cv::Scalar(double(i + 1));
	return view;
}

/** 20 boxes of one size. */
inline std::vector<cv::Rect> twentyBoxes(int width, int height)
{
	std::vector<cv::Rect> boxes;
	for (int i = 0; i < 20; i++)
		boxes.emplace_back(5 + 127 * (i % 5), 5 + 119 * (i / 5), width, height);
	return boxes;
}

/** A detector that does not err. */
inline SimulatedDetectorOptions withoutErrors()
{
	SimulatedDetectorOptions options;
	options.minimumArea = 0;
	options.missRate = options.missArea = options.boundaryNoise = 0;
	options.missHidden = 100;
	options.splitRate = options.mergeRate = options.falseRate = options.confusionRate = 0;
	return options;
}

/** One that errs in every way often. */
inline SimulatedDetectorOptions withManyErrors()
{
	SimulatedDetectorOptions options;
	options.boundaryNoise = 4;
	options.missRate = options.splitRate = options.mergeRate = options.confusionRate = 0.3;
	options.falseRate = 3;
	return options;
}

}  // namespace semloop
