#include "SceneNnImport.h"

#include <mrpt/core/format.h>
#include <semloop/config/Error.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/sensors/OniRecording.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "InstanceTruth.h"
#include "SceneNnTrajectory.h"
#include "TrueObjects.h"

namespace semloop
{
namespace
{
namespace fs = std::filesystem;
using mrpt::obs::CObservation3DRangeScan;

constexpr std::size_t kPosesBeyondTheEnd = 5;  // players differ in what they pair at the end
// PlaybackSync.cpp of hkust-vgd/scenenn: poses and mesh are of its frames, pixels as stored.
const OniReading kAsSceneNnsPlayer{true, std::chrono::microseconds(33000)};
constexpr double kLeastShareWithPose = 0.5;
constexpr double kLeastShareOnMesh =
	0.5;  // a wrong mesh: its floor, and a tenth of the rest by chance

std::string percent(double share)
{
	return mrpt::format("%.1f %%", 100 * share);
}

void exclude(
	SceneNnAnnotation& annotation, const std::vector<std::string>& names, const std::string& path)
{
	for (const auto& name : names)
	{
		const auto before = annotation.size();
		for (auto i = annotation.begin(); i != annotation.end();)
			i = i->second == name ? annotation.erase(i) : std::next(i);
		if (annotation.size() == before)
			throw UsageError("--exclude " + name + ": no label of " + path + " has this text");
	}
}

std::unique_ptr<InstanceTruth> readTruth(const SceneNnImport& import)
{
	if (import.annotation.empty()) return nullptr;
	auto annotation = readSceneNnAnnotation(import.annotation);
	exclude(annotation, import.exclude, import.annotation);
	return std::make_unique<InstanceTruth>(
		readAnnotatedMesh(import.mesh, annotation, import.annotation), import.tolerance);
}

class Importer
{
public:
	explicit Importer(const SceneNnImport& import)
		: import_(import),
		  prefix_(fs::path(import.rawlog).replace_extension().string()),
		  trajectory_(
			  import.trajectory.empty() ? SceneNnTrajectory{}
										: readSceneNnTrajectory(import.trajectory)),
		  truth_(readTruth(import)),
		  scans_(OniRecording(import.oni, kAsSceneNnsPlayer), import.camera, import.start),
		  rawlog_(import.rawlog)
	{
		if (truth_) instances_.emplace(prefix_ + "_truth_instances.rawlog");
	}

	void readAll(const std::function<void(std::size_t, double)>& progress)
	{
		while (const auto scan = scans_.next())
		{
			add(*scan);
			progress(frames_, scans_.recording().progress());
		}
		requireOneSequence();
	}

	/** Gives the files their final names. */
	void close()
	{
		if (!import_.trajectory.empty())
			writeTumTrajectory(prefix_ + "_groundtruth.tum", groundTruth_);
		if (truth_)
		{
			instances_->close();
			writeTrueObjects(prefix_, truth_->mesh(), truth_->observations());
		}
		rawlog_.close();
	}

	SceneNnReport report() const
	{
		SceneNnReport report;
		report.frames = frames_;
		report.unpairedColor = scans_.recording().unpairedColor();
		report.unpairedDepth = scans_.recording().unpairedDepth();
		report.poses = groundTruth_.size();
		if (!truth_) return report;
		const auto& seen = truth_->observations();
		report.objects = seen.size();
		report.objectsSeen = seen.size() - std::size_t(std::count(seen.begin(), seen.end(), 0));
		report.missingObjects = truth_->mesh().missing;
		report.shareOnMesh = truth_->shareOnMesh();
		return report;
	}

private:
	void add(CObservation3DRangeScan& scan)
	{
		if (const auto pose = trajectory_.at(frames_))
		{
			groundTruth_.push_back({scan.timestamp, *pose});
			if (truth_) instances_->write(truth_->of(scan, *pose));
		}
		if (!import_.embed) moveImagesOut(scan);
		rawlog_.write(scan);
		frames_++;
	}

	void moveImagesOut(CObservation3DRangeScan& scan)
	{
		if (frames_ == 0) imagesFolder_ = beginExternalImages(import_.rawlog);
		storeExternally(scan, imagesFolder_, frames_, ".png");
	}

	void requireOneSequence() const
	{
		const std::size_t poses = trajectory_.poses.size();
		if (poses > frames_ + kPosesBeyondTheEnd)
			throw InputError(
				import_.trajectory + ": its last pose is for frame " + std::to_string(poses - 1) +
				", but " + import_.oni + " has only " + std::to_string(frames_) +
				"; give the trajectory of this recording, or all of the recording");
		if (!import_.trajectory.empty() &&
			double(groundTruth_.size()) < kLeastShareWithPose * double(frames_))
			throw InputError(
				import_.trajectory + ": has poses for only " + std::to_string(groundTruth_.size()) +
				" of the " + std::to_string(frames_) + " frames of " + import_.oni +
				"; give the trajectory of this recording");
		if (truth_ && truth_->shareOnMesh() < kLeastShareOnMesh)
			throw InputError(
				import_.annotation + ": does not fit " + import_.oni + ": only " +
				percent(truth_->shareOnMesh()) + " of the depth is within " +
				mrpt::format("%g m of %s, ", import_.tolerance, import_.mesh.c_str()) +
				percent(kLeastShareOnMesh) +
				" are needed; give mesh, annotation and trajectory of this recording, or a larger "
				"--tolerance");
	}

	const SceneNnImport& import_;
	const std::string prefix_;
	const SceneNnTrajectory trajectory_;
	const std::unique_ptr<InstanceTruth> truth_;
	OniScans scans_;
	RawlogWriter rawlog_;
	std::string imagesFolder_;
	std::optional<RawlogWriter> instances_;
	std::size_t frames_ = 0;
	Trajectory groundTruth_;
};

}  // namespace

mrpt::img::TCamera sceneNnCamera()
{
	mrpt::img::TCamera camera;
	camera.cameraName = "asus";
	camera.ncols = 640;
	camera.nrows = 480;
	camera.setIntrinsicParamsFromValues(544.47329, 544.47329, 320, 240);
	return camera;
}

SceneNnReport importSceneNn(
	const SceneNnImport& import, const std::function<void(std::size_t, double)>& progress)
{
	Importer importer(import);
	importer.readAll(progress);
	importer.close();
	return importer.report();
}

}  // namespace semloop
