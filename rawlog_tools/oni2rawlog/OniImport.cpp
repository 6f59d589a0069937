#include "OniImport.h"

#include <semloop/config/Error.h>
#include <semloop/observations/CameraFile.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/OniRecording.h>
#include <sys/stat.h>

namespace semloop
{
namespace
{
mrpt::Clock::time_point timeOfLastChange(const std::string& path)
{
	struct stat status = {};
	if (::stat(path.c_str(), &status) != 0) throw InputError(path + ": cannot be read");
	return mrpt::Clock::fromDouble(double(status.st_mtime));
}

mrpt::img::TCamera cameraOf(const OniRecording& recording, const OniImport& import)
{
	return import.cameraFile.empty() ? recording.camera() : readCameraFile(import.cameraFile);
}

void requireSize(const OniImport& import, const mrpt::img::TCamera& camera, cv::Size size)
{
	if (size == cv::Size(int(camera.ncols), int(camera.nrows))) return;
	throw InputError(
		import.recording + ": images of " + std::to_string(size.width) + "x" +
		std::to_string(size.height) + " pixels where the camera of " + import.cameraFile + " has " +
		std::to_string(camera.ncols) + "x" + std::to_string(camera.nrows) +
		": give the right one with --camera");
}

std::optional<OniFrame> nextFrame(OniRecording& recording, const OniImport& import)
{
	try
	{
		return recording.next();
	}
	catch (const InputError& e)
	{
		throw InputError(
			std::string(e.what()) + "; the frames so far are in " +
			RawlogWriter::partialPath(import.rawlog));
	}
}

}  // namespace

OniImportReport importOni(
	const OniImport& import, const std::function<void(std::size_t, double)>& progress)
{
	OniRecording recording(import.recording);
	const mrpt::img::TCamera camera = cameraOf(recording, import);
	OniImportReport report;
	report.startTime = import.startTime.value_or(timeOfLastChange(import.recording));
	auto frame = recording.next();
	if (!frame)
		throw InputError(
			import.recording +
			": no colour and depth image in it were taken together: record it again");
	requireSize(import, camera, frame->color.size());

	RawlogWriter writer(import.rawlog);
	const std::string folder = import.embed ? "" : makeExternalImagesFolder(import.rawlog);
	for (const auto first = frame->time; frame; frame = nextFrame(recording, import))
	{
		const auto scan = rangeScanFrom(*frame, recording.depthUnit(), camera);
		const auto sinceStart = frame->time - first;
		scan->timestamp =
			report.startTime + std::chrono::duration_cast<mrpt::Clock::duration>(sinceStart);
		scan->sensorLabel = "RGBD";
		if (!import.embed)
		{
			storeColorExternally(*scan, folder, externalImageName("color", report.frames, ".png"));
			storeDepthExternally(*scan, folder, externalImageName("depth", report.frames, ".bin"));
		}
		writer.write(*scan);
		report.duration = std::chrono::duration<double>(sinceStart).count();
		progress(++report.frames, recording.progress());
	}
	writer.close();
	report.unpairedColor = recording.unpairedColor();
	report.unpairedDepth = recording.unpairedDepth();
	return report;
}

}  // namespace semloop
