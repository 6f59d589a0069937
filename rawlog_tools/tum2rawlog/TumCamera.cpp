#include "TumCamera.h"

#include <mrpt/config/CConfigFile.h>
#include <semloop/config/Error.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::img::TCamera;

TCamera kinect(const std::string& name, double fx, double fy, double cx, double cy)
{
	TCamera camera;
	camera.cameraName = name;
	camera.ncols = 640;
	camera.nrows = 480;
	camera.setIntrinsicParamsFromValues(fx, fy, cx, cy);
	return camera;
}

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

std::string secondLine(const std::string& what)
{
	const auto begin = what.find("Message:");
	if (begin == std::string::npos) return what.substr(0, what.find('\n'));
	const auto text = what.find_first_not_of(' ', begin + 8);
	return what.substr(text, what.find('\n', text) - text);
}

TCamera fromFile(const std::string& path)
{
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
		throw UsageError(path + ": not a camera as MRPT writes it: " + secondLine(e.what()));
	}
	if (!(camera.fx() > 0 && camera.fy() > 0) || camera.ncols == 0 || camera.nrows == 0)
		throw UsageError(path + ": resolution, fx and fy must be positive");
	return camera;
}

}  // namespace

TCamera tumCamera(const std::string& nameOrFile)
{
	if (nameOrFile == "fr1")
	{
		TCamera camera = kinect("fr1", 517.3, 516.5, 318.6, 255.3);
		camera.setDistortionPlumbBob(0.2624, -0.9531, -0.0054, 0.0026, 1.1633);
		return camera;
	}
	if (nameOrFile == "fr2")
	{
		TCamera camera = kinect("fr2", 520.9, 521.0, 325.1, 249.7);
		camera.setDistortionPlumbBob(0.2312, -0.7849, -0.0033, -0.0001, 0.9172);
		return camera;
	}
	if (nameOrFile == "fr3") return kinect("fr3", 535.4, 539.2, 320.1, 247.6);
	if (nameOrFile == "ros") return kinect("ros", 525.0, 525.0, 319.5, 239.5);
	if (!fs::is_regular_file(nameOrFile))
		throw UsageError("--camera " + nameOrFile + ": neither fr1, fr2, fr3 or ros nor a file");
	return fromFile(nameOrFile);
}

std::optional<std::string> guessTumCamera(const std::string& folder)
{
	fs::path path = fs::weakly_canonical(folder);
	if (!path.has_filename()) path = path.parent_path();
	std::string name = path.filename().string();
	std::transform(
		name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
	for (const std::string number : {"1", "2", "3"})
		for (const std::string prefix : {"fr", "freiburg"})
			if (name.find(prefix + number) != std::string::npos) return "fr" + number;
	return std::nullopt;
}

}  // namespace semloop
