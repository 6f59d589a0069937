#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>
#include <semloop/config/ExceptionMessage.h>
#include <semloop/observations/CameraFile.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace semloop
{
namespace
{
using mrpt::img::TCamera;

/** MRPT takes a camera without the key distortion_model for one without distortion. */
void readDistortion(
	const mrpt::config::CConfigFile& file, const std::string& section, TCamera& camera)
{
	if (file.keyExists(section, "distortion_model") || !file.keyExists(section, "dist")) return;
	const auto model = file.read_enum(section, "distortion", mrpt::img::DistortionModel::plumb_bob);
	std::vector<double> dist;
	file.read_vector(section, "dist", std::vector<double>(), dist);
	const std::size_t n = dist.size();
	if (n != 4 && n != 5 && n != 8)
		throw UsageError("dist must have 4, 5 or 8 numbers, not " + std::to_string(n));
	if (model == mrpt::img::DistortionModel::kannala_brandt)
		camera.setDistortionKannalaBrandt(dist[0], dist[1], dist[2], dist[3]);
	else
		camera.setDistortionParamsVector(dist);
	camera.distortion = model;
}

std::string onlySection(const mrpt::config::CConfigFile& file)
{
	std::vector<std::string> sections;
	file.getAllSections(sections);
	const std::string usual = "CAMERA_PARAMS";
	if (std::find(sections.begin(), sections.end(), usual) != sections.end()) return usual;
	if (sections.size() != 1) throw UsageError("needs a section [" + usual + "]");
	return sections.front();
}

}  // namespace

TCamera readCameraFile(const std::string& path)
{
	if (!std::filesystem::is_regular_file(path))
		throw UsageError(path + ": no such file: give a camera as MRPT writes it");
	TCamera camera;
	try
	{
		const mrpt::config::CConfigFile file(path);
		const std::string section = onlySection(file);
		camera.loadFromConfigFile(section, file);
		readDistortion(file, section, camera);
	}
	catch (const UsageError& e)
	{
		throw UsageError(path + ": " + e.what());
	}
	catch (const std::exception& e)
	{
		throw UsageError(path + ": not a camera as MRPT writes it: " + exceptionMessage(e));
	}
	if (!(camera.fx() > 0 && camera.fy() > 0) || camera.ncols == 0 || camera.nrows == 0)
		throw UsageError(path + ": resolution, fx and fy must be positive");
	return camera;
}

}  // namespace semloop
