#include "SimulationFiles.h"

#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "SceneFiles.h"

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
constexpr int kJpegQuality = 95;

std::string prefixOf(const std::string& rawlog)
{
	return fs::path(rawlog).replace_extension().string();
}

void storeColorExternally(
	mrpt::obs::CObservation3DRangeScan& scan, const std::string& folder, const std::string& name)
{
	const std::string path = (fs::path(folder) / name).string();
	if (!cv::imwrite(
			path, scan.intensityImage.asCvMatRef(), {cv::IMWRITE_JPEG_QUALITY, kJpegQuality}))
		throw InputError(path + ": cannot be written; is the disk full?");
	scan.intensityImage.setExternalStorage(name);
}

Trajectory firstOf(Trajectory trajectory, std::size_t count)
{
	trajectory.resize(std::min(count, trajectory.size()));
	return trajectory;
}
}  // namespace

SimulationFiles::SimulationFiles(const std::string& rawlog, bool embed)
	: prefix_(prefixOf(rawlog)),
	  imagesFolder_(embed ? "" : externalImagesFolder(rawlog)),
	  rawlog_(rawlog),
	  trueInstances_(prefix_ + "_truth_instances.rawlog"),
	  instances_(prefix_ + "_instances.rawlog")
{
	if (embed) return;
	std::error_code error;
	fs::create_directories(imagesFolder_, error);
	if (error) throw InputError(imagesFolder_ + ": cannot be made (" + error.message() + ")");
}

void SimulationFiles::write(SimulatedFrame& frame)
{
	if (!imagesFolder_.empty())
	{
		storeColorExternally(
			frame.scan, imagesFolder_, mrpt::format("color_%06zu.jpg", frames_));
		storeDepthExternally(
			frame.scan, imagesFolder_, mrpt::format("depth_%06zu.bin", frames_));
	}
	rawlog_.write(frame.acceleration);
	rawlog_.write(frame.scan);
	trueInstances_.write(frame.trueInstances);
	instances_.write(frame.instances);
	for (const auto& instance : frame.trueInstances.instances)
		++observations_[instance.trueObject.value()];
	++frames_;
}

void SimulationFiles::close(const Simulator& simulator, const FurnitureCatalog& catalog)
{
	rawlog_.close();
	trueInstances_.close();
	instances_.close();
	writeTumTrajectory(prefix_ + "_groundtruth.tum", firstOf(simulator.trajectory(), frames_));
	writeTumTrajectory(prefix_ + "_odometry.tum", firstOf(simulator.odometry(), frames_));
	writeTrueObjects(prefix_, simulator.scene(), observations_);
	writeAttribution(prefix_ + "_attribution.txt", simulator.scene(), catalog);
}

}  // namespace semloop
