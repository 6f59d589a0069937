#include "SimulationFiles.h"

#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>

#include <filesystem>
#include <fstream>
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

Trajectory firstOf(Trajectory trajectory, std::size_t count)
{
	trajectory.resize(std::min(count, trajectory.size()));
	return trajectory;
}

std::string colorName(std::size_t frame)
{
	return externalImageName("color", frame, ".jpg");
}

std::string depthName(std::size_t frame)
{
	return externalImageName("depth", frame, ".bin");
}
}  // namespace

SimulationFiles::SimulationFiles(const std::string& rawlog, bool embed, bool color)
	: prefix_(prefixOf(rawlog)),
	  imagesFolder_(embed ? "" : externalImagesFolder(rawlog)),
	  color_(color),
	  rawlog_(rawlog),
	  trueInstances_(prefix_ + "_truth_instances.rawlog"),
	  instances_(prefix_ + "_instances.rawlog")
{
	if (embed) return;
	std::error_code error;
	fs::create_directories(imagesFolder_, error);
	if (error) throw InputError(imagesFolder_ + ": cannot be made (" + error.message() + ")");
}

void SimulationFiles::storeColor(mrpt::obs::CObservation3DRangeScan& scan)
{
	const std::string name = colorName(frames_);
	const std::string path = (fs::path(imagesFolder_) / name).string();
	// Without colour all images are the same.
	if (color_ || jpeg_.empty())
		cv::imencode(
			".jpg", scan.intensityImage.asCvMatRef(), jpeg_,
			{cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
	std::ofstream out(path, std::ios::binary);
	out.write(reinterpret_cast<const char*>(jpeg_.data()), std::streamsize(jpeg_.size()));
	if (!out.flush()) throw InputError(path + ": cannot be written; is the disk full?");
	scan.intensityImage.setExternalStorage(name);
}

void SimulationFiles::write(SimulatedFrame& frame)
{
	if (!imagesFolder_.empty())
	{
		storeColor(frame.scan);
		storeDepthExternally(frame.scan, imagesFolder_, depthName(frames_));
	}
	rawlog_.write(frame.acceleration);
	rawlog_.write(frame.scan);
	trueInstances_.write(frame.trueInstances);
	instances_.write(frame.instances);
	for (const auto& instance : frame.trueInstances.instances)
		++observations_[instance.trueObject.value()];
	++frames_;
}

void SimulationFiles::removeImagesOfALongerRun() const
{
	if (imagesFolder_.empty()) return;
	const fs::path folder = imagesFolder_;
	for (std::size_t i = frames_; fs::exists(folder / depthName(i)); ++i)
	{
		fs::remove(folder / depthName(i));
		fs::remove(folder / colorName(i));
	}
}

void SimulationFiles::close(const Simulator& simulator, const FurnitureCatalog& catalog)
{
	removeImagesOfALongerRun();
	rawlog_.close();
	trueInstances_.close();
	instances_.close();
	writeTumTrajectory(prefix_ + "_groundtruth.tum", firstOf(simulator.trajectory(), frames_));
	writeTumTrajectory(prefix_ + "_odometry.tum", firstOf(simulator.odometry(), frames_));
	writeTrueObjects(prefix_, simulator.scene(), observations_);
	writeAttribution(prefix_ + "_attribution.txt", simulator.scene(), catalog);
}

}  // namespace semloop
