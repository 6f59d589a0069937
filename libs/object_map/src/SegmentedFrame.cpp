#include "SegmentedFrame.h"

#include <semloop/config/Error.h>
#include <semloop/observations/CameraFrames.h>
#include <semloop/observations/InstancePicture.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/observations/UnixTime.h>

namespace semloop
{
namespace
{
SegmentedFrame fromRectified(const CObservationInstances& observation)
{
	SegmentedFrame result;
	const cv::Size size = observation.imageSize();
	result.frame.time = observation.timestamp;
	result.frame.camera = observation.camera;
	result.frame.T_robot_camera = robotFromCamera(observation.sensorPose);
	result.frame.color = cv::Mat(size, CV_8UC3, cv::Scalar::all(160));
	result.frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar::all(0));
	result.instances = observation.instances;
	for (const auto& instance : observation.instances)
	{
		if (!instance.depth) continue;
		cv::Mat metres;
		instance.depth->depth.convertTo(metres, CV_32FC1, double(instance.depth->unit));
		metres.copyTo(result.frame.depth(instance.box), metres > 0);
		const auto color = labelColor(observation.labels.name(instance.label()));
		result.frame.color(instance.box)
			.setTo(cv::Scalar(color.B, color.G, color.R), instance.mask.decode(instance.box));
	}
	return result;
}
}  // namespace

SegmentedFrame SegmentedFrame::fromCrops(const CObservationInstances& observation)
{
	observation.validate();
	if (!hasDistortion(observation.camera)) return fromRectified(observation);
	return fromRectified(*Rectifier().rectify(observation));
}

SegmentedFrame SegmentedFrame::fromScan(
	const mrpt::obs::CObservation3DRangeScan& scan, const CObservationInstances& observation)
{
	observation.validate();
	Rectifier rectifier;
	SegmentedFrame result;
	const RgbdFrame frame = rgbdFrameFrom(scan);
	if (frame.color.size() != observation.imageSize())
		throw InputError(
			"instances at " + formatUnixTime(observation.timestamp) +
			" s are of an image of another size than the range scan's: segment the same images");
	result.frame = rectifier.rectify(frame);
	result.instances = rectifier.rectify(observation)->instances;
	return result;
}

}  // namespace semloop
