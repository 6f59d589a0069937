#include "VisibleObjects.h"

#include <semloop/config/Error.h>

#include <string>

namespace semloop
{
namespace
{
void requireView(const RenderedView& view)
{
	if (view.object.empty()) return;
	if (view.object.type() != CV_16UC1)
		throw InputError("view to detect in: its objects must be one channel of 16 bits");
	if (view.object.cols != int(view.camera.ncols) || view.object.rows != int(view.camera.nrows))
		throw InputError(
			"view to detect in: its image of " + std::to_string(view.object.cols) + "x" +
			std::to_string(view.object.rows) + " is not of its camera's size, " +
			std::to_string(view.camera.ncols) + "x" + std::to_string(view.camera.nrows));
}

void requireObject(const Scene& scene, std::size_t id)
{
	const std::string place = "scene " + scene.name + ": object " + std::to_string(id);
	if (id > scene.objects.size())
		throw InputError(
			place + " is in the view, but there are " + std::to_string(scene.objects.size()));
	const SceneObject& object = scene.objects[id - 1];
	if (object.id != id) throw InputError(place + " has the id " + std::to_string(object.id));
	if (object.label >= scene.labels.size())
		throw InputError(
			place + " has label " + std::to_string(object.label) + ", not among the " +
			std::to_string(scene.labels.size()) + " of the scene");
}

/** Runs of equal pixels, by id; those of 0 are left out. */
std::vector<std::vector<InstanceMask::Run>> runsById(const cv::Mat& objects)
{
	std::vector<std::vector<InstanceMask::Run>> runs;
	for (int y = 0; y < objects.rows; y++)
	{
		const auto* row = objects.ptr<uint16_t>(y);
		for (int begin = 0, end = 0; begin < objects.cols; begin = end)
		{
			const uint16_t id = row[begin];
			for (end = begin + 1; end < objects.cols && row[end] == id; end++)
			{
			}
			if (id == 0) continue;
			if (id >= runs.size()) runs.resize(id + std::size_t(1));
			runs[id].push_back({uint16_t(y), uint16_t(begin), uint16_t(end)});
		}
	}
	return runs;
}
}  // namespace

std::vector<VisibleObject> visibleObjects(const RenderedView& view, const Scene& scene)
{
	requireView(view);
	std::vector<VisibleObject> visible;
	auto runs = runsById(view.object);
	for (std::size_t id = 1; id < runs.size(); id++)
	{
		if (runs[id].empty()) continue;
		requireObject(scene, id);
		visible.push_back(
			{&scene.objects[id - 1], InstanceMask(view.object.size(), std::move(runs[id]))});
	}
	return visible;
}

}  // namespace semloop
