#include "OniImport.h"

#include <mrpt/system/datetime.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFile.h>
#include <semloop/observations/ExternalImages.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/OniRecording.h>
#include <sys/stat.h>

#include <utility>

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

mrpt::obs::CObservation3DRangeScan::Ptr nextScan(OniScans& scans, const OniImport& import)
{
	try
	{
		return scans.next();
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
	std::optional<mrpt::img::TCamera> camera;
	if (!import.cameraFile.empty()) camera = readCameraFile(import.cameraFile);
	OniImportReport report;
	report.startTime = import.startTime.value_or(timeOfLastChange(import.recording));
	OniScans scans(std::move(recording), camera, report.startTime);
	auto scan = scans.next();

	RawlogWriter writer(import.rawlog);
	const std::string folder = import.embed ? "" : beginExternalImages(import.rawlog);
	for (; scan; scan = nextScan(scans, import))
	{
		if (!import.embed) storeExternally(*scan, folder, report.frames, ".png");
		writer.write(*scan);
		report.duration = mrpt::system::timeDifference(report.startTime, scan->timestamp);
		progress(++report.frames, scans.recording().progress());
	}
	writer.close();
	report.unpairedColor = scans.recording().unpairedColor();
	report.unpairedDepth = scans.recording().unpairedDepth();
	return report;
}

}  // namespace semloop
