#include "ObjectSurfaces.h"

#include <semloop/config/Error.h>

#include <filesystem>
#include <map>
#include <system_error>
#include <vector>

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
/** The meshes of a folder by the number that their names begin with; none when there is no folder. */
std::map<std::string, std::string> meshesById(const fs::path& folder)
{
	std::map<std::string, std::string> meshes;
	std::error_code none;
	for (const auto& entry : fs::directory_iterator(folder, none))
	{
		const std::string name = entry.path().filename().string();
		if (entry.path().extension() == ".ply")
			meshes[name.substr(0, name.find_first_not_of("0123456789"))] = entry.path().string();
	}
	return meshes;
}
}  // namespace

SurfaceReport compareSurfaces(
	const std::string& runFolder, const std::string& truthFile, const ObjectEvaluation& objects,
	const mrpt::poses::CPose3D& T_truth_estimate)
{
	const fs::path estimateFolder = fs::path(runFolder) / "objects";
	const fs::path truthFolder = fs::path(truthFile).replace_extension();
	const auto estimates = meshesById(estimateFolder), truths = meshesById(truthFolder);

	SurfaceReport report;
	std::vector<double> distances;
	for (const ObjectMatch& match : objects.matches)
	{
		const auto estimate = estimates.find(std::to_string(match.estimate));
		const auto truth = truths.find(std::to_string(match.truth));
		if (estimate == estimates.end() || truth == truths.end()) continue;
		const Surface trueSurface = readPly(truth->second);
		if (trueSurface.triangles.empty())
			throw InputError(truth->second + ": has no triangle; give a mesh, not a point cloud");
		const auto errors = surfaceErrors(readPly(estimate->second), trueSurface, T_truth_estimate);
		distances.insert(distances.end(), errors.begin(), errors.end());
		report.objects++;
	}
	report.error = summarizeSurfaceErrors(std::move(distances));
	if (report.objects < objects.matches.size())
		report.note = std::to_string(objects.matches.size() - report.objects) + " of " +
					  std::to_string(objects.matches.size()) +
					  " matched objects have no mesh in both " + estimateFolder.string() + " and " +
					  truthFolder.string();
	return report;
}

}  // namespace semloop
