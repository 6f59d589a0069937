#include "Sidecar.h"

#include <mrpt/obs/CObservationComment.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>

#include <filesystem>
#include <functional>
#include <optional>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservationComment;
using nlohmann::json;

/** Settings in a sidecar's first entry; empty when it has none (stopped at once). Throws InputError
 *  when the file is something else. */
std::optional<json> settingsIn(const std::string& path)
{
	mrpt::obs::CObservation::Ptr first;
	try
	{
		first = RawlogReader(path).next();
	}
	catch (const InputError&)
	{
		return std::nullopt;
	}
	if (!first) return std::nullopt;
	const auto comment = std::dynamic_pointer_cast<CObservationComment>(first);
	auto settings = comment ? json::parse(comment->text, nullptr, false) : json();
	if (!settings.is_object() || !settings.contains("format"))
		throw InputError(
			path +
			": there is a file already that rawlog-segment did not write; name another with --out");
	return settings;
}

std::string valueAt(const json& settings, const json::json_pointer& place)
{
	return settings.contains(place) ? settings.at(place).dump() : "nothing";
}

void requireSameSettings(const std::string& path, const json& there, const json& wanted)
{
	if (there == wanted) return;
	const json::json_pointer place(json::diff(there, wanted).front().at("path").get<std::string>());
	throw InputError(
		path + ": was made with other settings (" + place.to_string().substr(1) + " was " +
		valueAt(there, place) + ", now " + valueAt(wanted, place) +
		"); add --force to make it anew, or name another with --out");
}

/** All whole observations with instances; a cut or damaged end is passed over. */
void readInstances(
	const std::string& path, const std::function<void(const CObservationInstances&)>& use)
{
	try
	{
		RawlogReader reader(path);
		while (const auto observation = reader.next())
			if (const auto* instances = dynamic_cast<CObservationInstances*>(observation.get()))
				use(*instances);
	}
	catch (const InputError&)
	{
		// An interrupted run ends like this; what it lacks is computed again.
	}
}
}  // namespace

void SidecarContents::add(const CObservationInstances& observation)
{
	times.insert(observation.timestamp);
	for (const auto& instance : observation.instances)
		instancesOfLabel[observation.labels.name(instance.label())]++;
}

std::size_t SidecarContents::instanceCount() const
{
	std::size_t sum = 0;
	for (const auto& [label, count] : instancesOfLabel) sum += count;
	return sum;
}

Sidecar::Sidecar(const std::string& path, const json& settings, bool force)
	: path_(path), settings_(settings)
{
	if (fs::exists(path) && !force)
	{
		const auto there = settingsIn(path);
		if (!there)
			throw InputError(
				path + ": there is a damaged file already; add --force to make it anew");
		requireSameSettings(path, *there, settings);
		readInstances(path, [&](const CObservationInstances& o) { contents_.add(o); });
		resumedFrames_ = contents_.times.size();
		complete_ = true;
		return;
	}
	beginAnew(force);
}

void Sidecar::beginAnew(bool force)
{
	const std::string partial = RawlogWriter::partialPath(path_);
	// The interrupted file is read while the writer fills a new one of its name.
	const std::string previous = path_ + ".previous";
	if (force)
	{
		fs::remove(previous);
		fs::remove(partial);
	}
	if (!fs::exists(previous) && fs::exists(partial))
	{
		if (const auto there = settingsIn(partial)) requireSameSettings(partial, *there, settings_);
		fs::rename(partial, previous);
	}
	writer_ = std::make_unique<RawlogWriter>(path_);
	if (!fs::exists(previous)) return;
	if (const auto there = settingsIn(previous))
	{
		requireSameSettings(previous, *there, settings_);
		readInstances(previous, [&](const CObservationInstances& o) { write(o); });
	}
	resumedFrames_ = contents_.times.size();
	fs::remove(previous);
}

void Sidecar::write(const CObservationInstances& observation)
{
	if (!headerWritten_)
	{
		CObservationComment header;
		header.timestamp = observation.timestamp;
		header.text = settings_.dump();
		writer_->write(header);
		headerWritten_ = true;
	}
	writer_->write(observation);
	contents_.add(observation);
}

void Sidecar::close()
{
	writer_->close();
}

}  // namespace semloop
