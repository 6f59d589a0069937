#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CTexturedPlane.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/InstancePicture.h>

#include <opencv2/imgproc.hpp>

namespace semloop
{
namespace
{
/** The picture of the masks where a screen would stand, kScreen in front of the camera. */
constexpr double kScreen = 1.0;  // [m]

mrpt::opengl::CTexturedPlane::Ptr screenOf(const CObservationInstances& observation)
{
	const auto& camera = observation.camera;
	const auto x = [&](double column) { return kScreen * (column - camera.cx()) / camera.fx(); };
	const auto y = [&](double row) { return kScreen * (row - camera.cy()) / camera.fy(); };
	auto screen = mrpt::opengl::CTexturedPlane::Create(
		float(x(-0.5)), float(x(camera.ncols - 0.5)), float(y(-0.5)), float(y(camera.nrows - 0.5)));
	screen->setName("instances");
	screen->assignImage(mrpt::img::CImage(drawInstances(observation), mrpt::img::DEEP_COPY));
	// The plane's axes are the optical frame's: x to the right, y down.
	screen->setPose(
		robotFromCamera(observation.sensorPose) + mrpt::poses::CPose3D(0, 0, kScreen, 0, 0, 0));
	return screen;
}

/** Appends the points of an instance's depth crop that its mask covers, in the optical frame. For
 *  looking at: the lens's distortion stays in. */
void appendPoints(
	const Instance& instance, const mrpt::img::TCamera& camera, const mrpt::img::TColor& color,
	mrpt::opengl::CPointCloudColoured& points)
{
	const cv::Mat& depth = instance.depth->depth;
	for (const auto& run : instance.mask.runs())
		for (int column = run.begin; column < run.end; column++)
		{
			const cv::Point pixel = cv::Point(column, run.row) - instance.box.tl();
			if (!cv::Rect({0, 0}, depth.size()).contains(pixel)) continue;
			const float z = float(depth.at<uint16_t>(pixel)) * instance.depth->unit;
			if (!(z > 0)) continue;
			const auto x = float((column - camera.cx()) / camera.fx()),
					   y = float((run.row - camera.cy()) / camera.fy());
			points.push_back(
				x * z, y * z, z, float(color.R) / 255, float(color.G) / 255, float(color.B) / 255);
		}
}
}  // namespace

void CObservationInstances::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const
{
	if (imageSize().area() > 0 && camera.fx() > 0 && camera.fy() > 0) out.insert(screenOf(*this));

	auto points = mrpt::opengl::CPointCloudColoured::Create();
	points->setName("points of the instances");
	points->setPointSize(2);
	points->setPose(robotFromCamera(sensorPose));
	for (const auto& instance : instances)
		if (instance.depth)
			appendPoints(instance, camera, labelColor(labels.name(instance.label())), *points);
	if (points->size() > 0) out.insert(points);
}

}  // namespace semloop
