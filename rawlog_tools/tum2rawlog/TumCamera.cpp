#include "TumCamera.h"

#include <semloop/config/Error.h>
#include <semloop/observations/CameraFile.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

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
	return readCameraFile(nameOrFile);
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
