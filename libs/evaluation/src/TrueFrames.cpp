#include <mrpt/obs/CObservation3DRangeScan.h>
#include <semloop/config/Error.h>
#include <semloop/evaluation/TrueFrames.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RgbdFrame.h>
#include <semloop/observations/UnixTime.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>

namespace semloop
{
namespace
{
constexpr std::chrono::milliseconds kRounding(1);

struct TrueInstance
{
	uint32_t object = 0;
	cv::Rect box;
	InstanceMask mask;
};
using TrueInstances = std::map<mrpt::Clock::time_point, std::vector<TrueInstance>>;

TrueInstances readTrueInstances(const std::string& rawlog)
{
	RawlogReader reader(rawlog);
	TrueInstances result;
	bool any = false;
	while (const auto observation = reader.next())
		if (const auto* seen = dynamic_cast<const CObservationInstances*>(observation.get()))
		{
			auto& instances = result[seen->timestamp];
			instances.clear();  // what a file tells twice counts once
			for (const Instance& instance : seen->instances)
				if (instance.trueObject)
					instances.push_back({*instance.trueObject, instance.box, instance.mask});
			any = any || !instances.empty();
		}
	if (!any)
		throw InputError(
			rawlog +
			": no instance in it says which real object it is; give the rawlog of the true "
			"instances");
	return result;
}

template <typename PixelsOf>
TrueFrame trueFrameOf(
	mrpt::Clock::time_point time, const std::vector<TrueInstance>& instances,
	const PixelsOf& pixelsOf)
{
	TrueFrame frame;
	frame.time = time;
	for (const TrueInstance& instance : instances)
		frame.boxes.push_back({instance.object, instance.box, pixelsOf(instance.mask)});
	return frame;
}

std::size_t measuredPixels(const InstanceMask& mask, const cv::Mat& depth)
{
	std::size_t count = 0;
	for (const auto& run : mask.runs())
		for (int u = run.begin; u < run.end; ++u) count += depth.at<float>(run.row, u) > 0;
	return count;
}

/** Empty for a frame that a run skips, too: images are missing or damaged. */
cv::Mat depthOf(const mrpt::obs::CObservation3DRangeScan& scan)
{
	try
	{
		return rgbdFrameFrom(scan).depth;
	}
	catch (const InputError&)
	{
		return {};
	}
}

/** Number of the pose at this time. */
std::optional<std::size_t> poseAt(const Trajectory& run, mrpt::Clock::time_point time)
{
	const auto isBefore = [](const StampedPose& pose, mrpt::Clock::time_point t)
	{ return pose.time < t; };
	const auto first = std::lower_bound(run.begin(), run.end(), time - kRounding, isBefore);
	const auto behind = std::lower_bound(first, run.end(), time + kRounding, isBefore);
	if (first == behind) return std::nullopt;
	const auto distance = [&](const StampedPose& pose)
	{ return std::chrono::abs(pose.time - time); };
	const auto nearest = std::min_element(
		first, behind, [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
	return std::size_t(nearest - run.begin());
}

std::string spanOf(mrpt::Clock::time_point first, mrpt::Clock::time_point last)
{
	return formatUnixTime(first) + " to " + formatUnixTime(last);
}
}  // namespace

std::vector<TrueFrame> readTrueFrames(const std::string& rawlog, const std::string& images)
{
	const TrueInstances truth = readTrueInstances(rawlog);
	std::vector<TrueFrame> frames;
	if (images.empty())
	{
		const auto area = [](const InstanceMask& mask) { return mask.area(); };
		for (const auto& [time, instances] : truth)
			frames.push_back(trueFrameOf(time, instances, area));
		return frames;
	}

	RawlogReader reader(images);
	while (const auto observation = reader.next())
	{
		const auto* scan =
			dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(observation.get());
		if (!scan) continue;
		const auto found = truth.lower_bound(scan->timestamp - kRounding);
		if (found == truth.end() || found->first > scan->timestamp + kRounding) continue;
		const cv::Mat depth = depthOf(*scan);
		if (depth.empty()) continue;
		const auto measured = [&](const InstanceMask& mask)
		{
			if (mask.imageSize() != depth.size())
				throw InputError(
					images + " with " + rawlog +
					": images and true instances differ in size; give those of one simulation");
			return measuredPixels(mask, depth);
		};
		frames.push_back(trueFrameOf(found->first, found->second, measured));
	}
	std::stable_sort(
		frames.begin(), frames.end(),
		[](const TrueFrame& a, const TrueFrame& b) { return a.time < b.time; });
	if (frames.empty())
		throw InputError(
			images + " with " + rawlog +
			": no image is of the time of true instances; give those of one simulation");
	return frames;
}

std::vector<RunFrame> joinWithTruth(
	const Trajectory& run, const std::vector<AssociationRecord>& associations,
	const std::vector<TrueFrame>& truth)
{
	std::map<std::size_t, RunFrame> frames;
	for (const TrueFrame& t : truth)
		if (const auto index = poseAt(run, t.time)) frames[*index] = {*index, t.boxes, {}};
	if (frames.empty())
		throw InputError(
			run.empty() || truth.empty()
				? std::string("result or truth has no frame: give those of one rawlog")
				: "no frame of the result (" + spanOf(run.front().time, run.back().time) +
					  ") is one of the truth (" + spanOf(truth.front().time, truth.back().time) +
					  "): give those of one rawlog");
	for (const AssociationRecord& a : associations)
		if (const auto frame = frames.find(a.frame); frame != frames.end())
			frame->second.estimate.push_back(a);

	std::vector<RunFrame> result;
	for (auto& entry : frames) result.push_back(std::move(entry.second));
	return result;
}

}  // namespace semloop
