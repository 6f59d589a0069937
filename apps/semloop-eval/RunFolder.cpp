#include "RunFolder.h"

#include <semloop/config/Error.h>

#include <cstdio>
#include <filesystem>

#include "Application.h"

namespace fs = std::filesystem;

namespace semloop
{
std::string runFile(const std::string& folder, const std::string& name)
{
	if (!fs::is_directory(folder))
		throw InputError(folder + ": no such folder; give the one that semloop-slam wrote to");
	const std::string path = (fs::path(folder) / name).string();
	requireFile(path, "give a folder that semloop-slam wrote to, or run it again");
	return path;
}

std::vector<RunFrame> runWithTruth(
	const std::string& folder, const std::string& truthRawlog, const std::string& images)
{
	const auto run = readTumTrajectory(runFile(folder, "trajectory.tum"));
	const auto associations = readAssociations(runFile(folder, "associations.csv"));
	requireFile(truthRawlog, "give the rawlog of the true instances");
	if (!images.empty()) requireFile(images, "give the rawlog that the run was made of");
	const auto truth = readTrueFrames(truthRawlog, images);
	try
	{
		return joinWithTruth(run, associations, truth);
	}
	catch (const InputError& e)
	{
		throw InputError(folder + " with " + truthRawlog + ": " + e.what());
	}
}

nlohmann::ordered_json numberOrNull(const std::optional<double>& value)
{
	if (!value) return nullptr;
	return *value;
}

nlohmann::ordered_json toJson(const ErrorSummary& errors, double scale)
{
	nlohmann::ordered_json json{{"count", errors.count}};
	const auto tell = [&](const char* name, double value)
	{ json[name] = errors.count > 0 ? nlohmann::ordered_json(value * scale) : nullptr; };
	tell("rmse", errors.rmse);
	tell("mean", errors.mean);
	tell("median", errors.median);
	tell("max", errors.max);
	return json;
}

std::string toText(const std::optional<double>& value)
{
	if (!value) return "-";
	char text[32];
	std::snprintf(text, sizeof(text), "%.4f", *value);
	return text;
}

}  // namespace semloop
