#include "SimulationFiles.h"

#include <semloop/observations/ExternalImages.h>

#include <filesystem>

#include "SceneFiles.h"

namespace fs = std::filesystem;

namespace semloop
{
namespace
{
std::string prefixOf(const std::string& rawlog)
{
	return fs::path(rawlog).replace_extension().string();
}

Trajectory firstOf(Trajectory trajectory, std::size_t count)
{
	trajectory.resize(std::min(count, trajectory.size()));
	return trajectory;
}
}  // namespace

SimulationFiles::SimulationFiles(const std::string& rawlog, bool embed)
	: prefix_(prefixOf(rawlog)),
	  rawlog_(rawlog),
	  trueInstances_(prefix_ + "_truth_instances.rawlog"),
	  instances_(prefix_ + "_instances.rawlog")
{
	if (!embed) imagesFolder_ = beginExternalImages(rawlog);
}

void SimulationFiles::write(SimulatedFrame& frame)
{
	if (!imagesFolder_.empty()) storeExternally(*frame.scan, imagesFolder_, frames_, ".jpg");
	rawlog_.write(frame.acceleration);
	rawlog_.write(*frame.scan);
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
