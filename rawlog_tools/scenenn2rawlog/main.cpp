#include <semloop/config/Error.h>
#include <semloop/observations/CameraFile.h>
#include <semloop/observations/Rectifier.h>
#include <semloop/observations/UnixTime.h>

#include <cstdio>

#include "Application.h"
#include "ProgressBar.h"
#include "SceneNnImport.h"

namespace
{
using namespace semloop;

const char* const kName = "scenenn2rawlog";
const char* const kDefaultStart = "1577836800";  // 2020-01-01

void requireConsistent(const SceneNnImport& import)
{
	if (!import.annotation.empty() && import.mesh.empty())
		throw UsageError("--annotation needs the annotated mesh; add --mesh X.ply");
	if (!import.mesh.empty() && import.annotation.empty())
		throw UsageError("--mesh is only for an annotation; add --annotation X.xml");
	if (!import.annotation.empty() && import.trajectory.empty())
		throw UsageError("--annotation needs the camera's poses; add --trajectory trajectory.log");
	if (!import.exclude.empty() && import.annotation.empty())
		throw UsageError("--exclude is only for an annotation; add --annotation X.xml");
	if (!(import.tolerance > 0 && import.tolerance <= 1))
		throw UsageError("--tolerance must lie in (0, 1] metres");
}

mrpt::Clock::time_point parseStart(const std::string& text)
{
	const auto time = parseUnixTime(text);
	if (!time || *time <= mrpt::Clock::fromDouble(0))
		throw UsageError(
			"--start-time " + text + ": not a time; give seconds since 1970, more than 0");
	return *time;
}

mrpt::img::TCamera chooseCamera(const std::string& file)
{
	if (file.empty()) return sceneNnCamera();
	const auto camera = readCameraFile(file);
	if (hasDistortion(camera))
		throw UsageError(
			file +
			": has lens distortion, but SceneNN's poses and meshes were made without; set dist "
			"to zeros");
	return camera;
}

/** False when --help or --version has been answered. */
bool parse(int argc, char** argv, SceneNnImport& import)
{
	TCLAP::CmdLine line(
		"Turns a sequence of the SceneNN dataset into a rawlog, with the truth about camera and "
		"objects.",
		' ', SEMLOOP_VERSION);
	using Text = TCLAP::ValueArg<std::string>;
	TCLAP::UnlabeledValueArg<std::string> oni(
		"oni", "The sequence's recording.", true, "", "IN.oni", line);
	TCLAP::UnlabeledValueArg<std::string> rawlog(
		"rawlog", "Rawlog to write; everything else is named after it.", true, "", "OUT.rawlog",
		line);
	TCLAP::SwitchArg embed("", "embed", "Images inside the rawlog.", line);
	Text camera(
		"", "camera", "MRPT's TCamera for colour and depth instead of SceneNN's Xtion.", false, "",
		"FILE.ini", line);
	Text start(
		"", "start-time", "Unix time of the first frame [s]; 2020-01-01 unless given.", false,
		kDefaultStart, "T", line);
	TCLAP::ValueArg<double> tolerance(
		"", "tolerance",
		"Pixels within this distance of the mesh are on it [m]; 0.05 unless given.", false,
		import.tolerance, "M", line);
	TCLAP::MultiArg<std::string> exclude(
		"", "exclude", "A text of the annotation that is no instance, e.g. wall; may be repeated.",
		false, "TEXT", line);
	Text mesh("", "mesh", "The annotated mesh.", false, "", "X.ply", line);
	Text annotation(
		"", "annotation", "The annotation of the mesh's instances.", false, "", "X.xml", line);
	Text trajectory("", "trajectory", "The camera's poses.", false, "", "trajectory.log", line);
	if (!parseArguments(line, argc, argv)) return false;

	import.oni = oni.getValue();
	import.rawlog = rawlog.getValue();
	import.embed = embed.getValue();
	import.trajectory = trajectory.getValue();
	import.annotation = annotation.getValue();
	import.mesh = mesh.getValue();
	import.exclude = exclude.getValue();
	import.tolerance = tolerance.getValue();
	import.start = parseStart(start.getValue());
	requireConsistent(import);
	import.camera = chooseCamera(camera.getValue());
	return true;
}

void print(const SceneNnImport& import, const SceneNnReport& report)
{
	std::printf(
		"%s: %zu frames, %zu colour and %zu depth images without partner", import.rawlog.c_str(),
		report.frames, report.unpairedColor, report.unpairedDepth);
	if (!import.trajectory.empty()) std::printf(", %zu frames with a pose", report.poses);
	if (!import.annotation.empty())
		std::printf(
			", %zu objects (%zu seen; %zu more are not in the mesh), %.1f %% of the depth on the "
			"mesh",
			report.objects, report.objectsSeen, report.missingObjects, 100 * report.shareOnMesh);
	std::printf("\n");
}

int run(int argc, char** argv)
{
	SceneNnImport import;
	if (!parse(argc, argv, import)) return kSuccess;
	requireFile(import.oni, "give the recording of a SceneNN sequence");
	ProgressBar bar("converting");
	const auto report =
		importSceneNn(import, [&](std::size_t frames, double share) { bar.update(frames, share); });
	bar.clear();
	print(import, report);
	return kSuccess;
}

}  // namespace

int main(int argc, char** argv)
{
	return runApplication(kName, [&] { return run(argc, argv); });
}
