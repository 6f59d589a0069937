#include "Merge.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/UnixTime.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;
using Time = mrpt::Clock::time_point;
using Object = mrpt::serialization::CSerializable;

const CObservationInstances* asInstances(const Object& object)
{
	return dynamic_cast<const CObservationInstances*>(&object);
}

/** The comment that rawlog-segment writes first. */
bool isSidecarHeader(const Object& object)
{
	const auto* const comment = dynamic_cast<const mrpt::obs::CObservationComment*>(&object);
	if (!comment) return false;
	const auto settings = nlohmann::json::parse(comment->text, nullptr, false);
	if (!settings.is_object() || !settings.contains("format")) return false;
	const auto& format = settings["format"];
	return format.is_string() && format.get<std::string>().rfind("semloop.instances/", 0) == 0;
}

bool isFrameWithInstances(const Object& object)
{
	const auto* const frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object);
	return frame &&
		   std::any_of(
			   frame->begin(), frame->end(),
			   [](const auto& observation) { return asInstances(*observation) != nullptr; });
}

std::vector<Time> scanTimes(const Object& object)
{
	std::vector<Time> times;
	if (const auto* const scan = dynamic_cast<const CObservation3DRangeScan*>(&object))
		times.push_back(scan->timestamp);
	if (const auto* const frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object))
		for (const auto& observation : *frame)
			if (dynamic_cast<const CObservation3DRangeScan*>(observation.get()))
				times.push_back(observation->timestamp);
	return times;
}

/** The next object; nothing at the end, or where the file is damaged, which is noted. */
std::optional<RawlogObject> nextOf(RawlogReader& reader, std::string& damage)
{
	try
	{
		return reader.nextObject();
	}
	catch (const DamagedRawlogError& e)
	{
		if (damage.empty()) damage = e.what();
		return std::nullopt;
	}
}

/** A sidecar's instances, one after the other. */
class SidecarCursor
{
public:
	SidecarCursor(const std::string& path, std::string& damage) : reader_(path), damage_(damage)
	{
		advance();
	}

	/** Of the next instances; nothing at the end. */
	const std::optional<Time>& time() const { return time_; }

	void writeTo(RawlogWriter& writer)
	{
		for (const auto& bytes : headers_) writer.writeBytes(bytes);
		headers_.clear();
		if (time_) writer.writeBytes(bytes_);
	}

	/** Headers stay until they are written. */
	void advance()
	{
		const auto before = time_;
		time_.reset();
		while (auto next = nextOf(reader_, damage_))
		{
			if (const auto* const instances = asInstances(*next->object))
			{
				time_ = instances->timestamp;
				bytes_ = std::move(next->bytes);
				if (before && *time_ <= *before)
					throw InputError(
						reader_.name() + ": the instances at " + formatUnixTime(*time_) +
						" s are not later than those before them");
				return;
			}
			if (!isSidecarHeader(*next->object))
				throw InputError(
					reader_.name() + ": holds a " + next->object->GetRuntimeClass()->className +
					": not a sidecar with instances alone");
			headers_.push_back(std::move(next->bytes));
		}
	}

private:
	RawlogReader reader_;
	std::string& damage_;
	std::vector<std::string> headers_;
	std::optional<Time> time_;
	std::string bytes_;
};

/** Passes over instances that are before a time: no scan is theirs. */
void passOver(
	SidecarCursor& sidecar, const std::optional<Time>& before, bool allowed,
	const MergeFiles& files, MergeReport& report)
{
	for (; sidecar.time() && (!before || *sidecar.time() < *before); sidecar.advance())
	{
		if (!allowed)
			throw InputError(
				files.instances + ": " + files.rawlog + " has no range scan of " +
				formatUnixTime(*sidecar.time()) +
				" s: is it the sidecar of this rawlog? --leave-out merges the others");
		report.left++;
	}
}

}  // namespace

MergeReport mergeInstances(const MergeFiles& files, bool leaveOut, const MergeProgress& progress)
{
	MergeReport report;
	RawlogReader reader(files.rawlog);
	SidecarCursor sidecar(files.instances, report.damage);
	RawlogWriter writer(files.merged);
	std::optional<Time> last;
	while (const auto next = nextOf(reader, report.damage))
	{
		if (asInstances(*next->object))
			throw InputError(files.rawlog + ": has instances already; --split takes them out");
		if (isFrameWithInstances(*next->object))
			throw InputError(files.rawlog + ": has instances already, in its sensory frames");
		// What is left of a sidecar whose instances were removed would come out of a split.
		if (isSidecarHeader(*next->object)) continue;
		writer.writeBytes(next->bytes);
		report.objects++;
		for (const auto& time : scanTimes(*next->object))
		{
			if (last && time < *last)
				throw InputError(
					files.rawlog + ": the range scan of " + formatUnixTime(time) +
					" s comes behind one of " + formatUnixTime(*last) +
					" s; merging needs them in order of time");
			last = time;
			passOver(sidecar, time, leaveOut, files, report);
			if (sidecar.time() != time) continue;
			sidecar.writeTo(writer);
			sidecar.advance();
			report.instances++;
		}
		progress(report.objects, reader.progress());
	}
	// Behind a cut nobody knows whose they are.
	passOver(sidecar, std::nullopt, leaveOut || !report.damage.empty(), files, report);
	sidecar.writeTo(writer);
	writer.close();
	return report;
}

MergeReport splitInstances(const MergeFiles& files, const MergeProgress& progress)
{
	MergeReport report;
	RawlogReader reader(files.merged);
	RawlogWriter rawlog(files.rawlog), instances(files.instances);
	while (const auto next = nextOf(reader, report.damage))
	{
		if (isFrameWithInstances(*next->object))
			throw InputError(
				files.merged +
				": has instances in sensory frames; --split takes out those that "
				"rawlog-merge-instances put in");
		const bool isInstances = asInstances(*next->object) != nullptr;
		const bool isOfSidecar = isInstances || isSidecarHeader(*next->object);
		(isOfSidecar ? instances : rawlog).writeBytes(next->bytes);
		report.instances += isInstances;
		report.objects += !isOfSidecar;
		progress(report.objects, reader.progress());
	}
	if (report.instances == 0 && report.damage.empty())
		throw InputError(files.merged + ": has no instances that could be taken out");
	rawlog.close();
	instances.close();
	return report;
}

void requireFreeImagesFolder(const std::string& from, const std::string& to, bool force)
{
	const fs::path folder = externalImagesFolder(from), link = externalImagesFolder(to);
	std::error_code error;
	if (!fs::is_directory(folder, error) || fs::equivalent(folder, link, error)) return;
	const auto there = fs::symlink_status(link, error);
	if (!fs::exists(there)) return;
	if (!fs::is_symlink(there))
		throw InputError(
			link.string() + ": is there already and not " + folder.string() +
			", where the images of " + to + " will be; name another output or move it away");
	if (!force)
		throw InputError(
			link.string() +
			": is a link to other images already; name another output or add "
			"--force");
}

void linkExternalImages(const std::string& from, const std::string& to)
{
	const fs::path folder = externalImagesFolder(from), link = externalImagesFolder(to);
	std::error_code error;
	if (!fs::is_directory(folder, error) || fs::equivalent(folder, link, error)) return;
	if (fs::is_symlink(link, error)) fs::remove(link, error);
	const auto parent = fs::absolute(link).parent_path();
	fs::create_directory_symlink(fs::relative(folder, parent), link, error);
	if (error)
		throw InputError(
			link.string() + ": cannot be made (" + error.message() + "): the images of " + to +
			" are in " + folder.string() + ", copy that folder to this name");
}

}  // namespace semloop
