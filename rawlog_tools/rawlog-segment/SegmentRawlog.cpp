#include "SegmentRawlog.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RgbdFrame.h>

#include <cmath>
#include <optional>

namespace semloop
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

/** Depth in a box, in steps of unit [m]. */
DepthCrop depthCrop(const cv::Mat& depth, const cv::Rect& box, float unit)
{
	DepthCrop crop;
	crop.unit = unit;
	depth(box).convertTo(crop.depth, CV_16U, 1.0 / double(unit));
	return crop;
}

CObservationInstances::Ptr segmentFrame(
	const CObservation3DRangeScan& scan, const RgbdFrame& frame, bool depthCrops,
	Networks& networks)
{
	const auto found = networks.segmenter->segment(frame);
	found->sensorPose = scan.sensorPose;
	addEmbeddings(*networks.embedder, frame.color, *found);
	if (depthCrops)
		for (auto& instance : found->instances)
			instance.depth = depthCrop(frame.depth, instance.box, scan.rangeUnits);
	return found;
}

/** The next range scan; empty at the end. A rawlog that was cut ends there, with the reason. */
CObservation3DRangeScan::Ptr nextScan(RawlogReader& reader, std::string& damage)
{
	try
	{
		while (const auto observation = reader.next())
			if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(observation))
				return scan;
	}
	catch (const InputError& e)
	{
		damage = e.what();
	}
	return nullptr;
}

std::string place(std::size_t index, const CObservation3DRangeScan& scan)
{
	return "frame " + std::to_string(index) + " at " +
		   std::to_string(mrpt::Clock::toDouble(scan.timestamp)) + " s";
}

/** A frame's images; empty, with a warning, when they cannot be used. */
std::optional<RgbdFrame> readFrame(
	const CObservation3DRangeScan& scan, std::size_t index, const SegmentationEvents& events)
{
	try
	{
		return rgbdFrameFrom(scan);
	}
	catch (const InputError& e)
	{
		events.warning(place(index, scan) + " is skipped: " + e.what());
		return std::nullopt;
	}
}
}  // namespace

SegmentationReport segmentRawlog(
	const Arguments& arguments, Networks& networks, Sidecar& sidecar,
	const SegmentationEvents& events)
{
	SegmentationReport report;
	RawlogReader reader(arguments.rawlog);
	std::optional<mrpt::Clock::time_point> last;
	for (std::size_t index = 0;; index++)
	{
		const auto scan = nextScan(reader, report.inputDamage);
		if (!scan) break;
		if (index % std::size_t(arguments.every) != 0) continue;
		report.stopped = events.stopRequested();
		if (report.stopped) return report;
		report.frames++;
		events.progress(report.frames, reader.progress());

		if (last && scan->timestamp <= *last)
		{
			events.warning(
				place(index, *scan) + " is skipped: its time is not after the frame's before");
			report.skipped++;
			continue;
		}
		last = scan->timestamp;
		if (sidecar.contents().times.count(scan->timestamp)) continue;
		if (const auto frame = readFrame(*scan, index, events))
			sidecar.write(*segmentFrame(*scan, *frame, arguments.depthCrops, networks));
		else
			report.skipped++;
	}
	if (!sidecar.contents().times.empty()) sidecar.close();
	return report;
}

}  // namespace semloop
