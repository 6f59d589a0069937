#include <semloop/config/Error.h>
#include <semloop/evaluation/TrueFrames.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogReader.h>
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

TrueFrame trueFrameOf(const CObservationInstances& instances)
{
	TrueFrame frame;
	frame.time = instances.timestamp;
	for (const Instance& instance : instances.instances)
		if (instance.trueObject)
			frame.boxes.push_back({*instance.trueObject, instance.box, instance.mask.area()});
	return frame;
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

std::vector<TrueFrame> readTrueFrames(const std::string& rawlog)
{
	RawlogReader reader(rawlog);
	std::vector<TrueFrame> frames;
	std::size_t boxes = 0;
	while (const auto observation = reader.next())
		if (const auto* instances = dynamic_cast<const CObservationInstances*>(observation.get()))
		{
			frames.push_back(trueFrameOf(*instances));
			boxes += frames.back().boxes.size();
		}
	if (boxes == 0)
		throw InputError(
			rawlog +
			": no instance in it says which real object it is; give the rawlog of the true "
			"instances");
	std::stable_sort(
		frames.begin(), frames.end(),
		[](const TrueFrame& a, const TrueFrame& b) { return a.time < b.time; });
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
