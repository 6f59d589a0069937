#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/observations/RawlogWriter.h>

#include <memory>
#include <string>

#include "../openni2/VirtualCameraFolder.h"
#include "SceneNnSequence.h"
#include "Shell.h"
#include "TemporaryFolder.h"

namespace semloop::test
{
/** scenenn2rawlog, the program, on a small sequence that is recorded once. */
class SceneNn2Rawlog : public ::testing::Test
{
protected:
	static void SetUpTestSuite()
	{
		sequence_ = std::make_unique<TemporaryFolder>();
		record("record", "076.oni", kFrames, synthetic::smallCamera());
		sequence_->write("076.ply", sceneMesh().ply());
		sequence_->write("076.xml", kAnnotation);
		sequence_->write("trajectory.log", trajectoryLog());
		mrpt::config::CConfigFileMemory camera;
		synthetic::smallCamera().saveToConfigFile("CAMERA_PARAMS", camera);
		sequence_->write("camera.ini", camera.getContent());
	}
	static void TearDownTestSuite() { sequence_.reset(); }

	static void record(
		const std::string& how, const std::string& oni, int frames,
		const mrpt::img::TCamera& camera)
	{
		RawlogWriter writer(sequence_->file("camera.rawlog"));
		for (int i = 0; i < frames; i++) writer.write(scanOf(viewOf(i, camera), i));
		writer.close();
		const auto recorded = shell(
			virtualCamera("camera.rawlog") +
				"timeout 60 " SEMLOOP_BINARY_DIR "/openni2/oni-recorder " + how + " " + oni,
			sequence_->path());
		ASSERT_EQ(recorded.code, 0) << recorded.err;
	}

	static std::string quoted(const std::string& path) { return "'" + path + "'"; }
	static std::string given(const std::string& file) { return quoted(sequence_->file(file)); }
	std::string written(const std::string& file) const { return folder_.file(file); }

	ShellResult runWith(const std::string& arguments) const
	{
		return shell(
			"timeout 120 " SEMLOOP_BINARY_DIR "/bin/scenenn2rawlog " + arguments, folder_.path());
	}
	/** On the recording, with its camera. */
	ShellResult run(const std::string& options) const
	{
		return runWith(
			"--camera " + given("camera.ini") + " " + options + " " + given("076.oni") +
			" room.rawlog");
	}
	/** With trajectory, annotation and mesh, each the sequence's own unless another file is named. */
	ShellResult runAnnotated(
		const std::string& options = "", const std::string& trajectory = "",
		const std::string& annotation = "", const std::string& mesh = "") const
	{
		const auto orOwn = [](const std::string& path, const char* own)
		{ return path.empty() ? given(own) : quoted(path); };
		return run(
			"--trajectory " + orOwn(trajectory, "trajectory.log") + " --annotation " +
			orOwn(annotation, "076.xml") + " --mesh " + orOwn(mesh, "076.ply") + " " + options);
	}

	inline static std::unique_ptr<TemporaryFolder> sequence_;
	const TemporaryFolder folder_;
};
}  // namespace semloop::test
