#include <semloop/observations/InstancePicture.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "HeldFile.h"
#include "SemloopSlamFixture.h"
#include "Shell.h"
#include "XWindowDump.h"

using namespace semloop;
using namespace semloop::synthetic;
using testing::HasSubstr;
using testing::StartsWith;

namespace
{
constexpr double kDegrees = 95, kStep = 5;

// Where the window, as large as the screen, has what.
const cv::Rect kPicture(10, 10, 480, 360), kButtons(10, 410, 480, 40), kMap(500, 0, 780, 960);

/** semloop-slam with a window on a recording of 20 frames; it waits for the colour images of some. */
class SemloopSlamGui : public SemloopSlamFixture
{
protected:
	void SetUp() override
	{
		if (!isInstalled("Xvfb")) GTEST_SKIP() << "Xvfb (package xvfb) is not installed";
	}

	void start(const std::vector<int>& heldFrames)
	{
		RunOptions options;
		options.degrees = kDegrees;
		options.step = kStep;
		recorded_ = recordRun(folder_, options);
		const RecordedRun held = changed(
			recorded_,
			[&](int index, mrpt::obs::CObservation3DRangeScan& scan)
			{
				if (std::count(heldFrames.begin(), heldFrames.end(), index) == 0) return;
				const std::string file = folder_.file("held" + std::to_string(index) + ".png");
				std::vector<uint8_t> png;
				cv::imencode(".png", scan.intensityImage.asCvMatRef(), png);
				held_[index] =
					std::make_unique<HeldFile>(file, std::string(png.begin(), png.end()));
				scan.intensityImage.setExternalStorage(file);
			});
		std::filesystem::create_directory(folder_.file("screen"));
		// No frames ahead: while the program waits for a frame, it has mapped all before.
		program_ = std::make_unique<ChildProcess>(
			std::vector<std::string>{
				// MRPT's NanoGUI deletes its widgets otherwise than it makes them; OpenGL's driver is
				// unloaded, so that LeakSanitizer finds no name to suppress.
				"/usr/bin/env", "ASAN_OPTIONS=alloc_dealloc_mismatch=0:detect_leaks=0",
				SEMLOOP_SOURCE_DIR "/tests/common/on_xvfb.sh", folder_.file("screen"), kProgram,
				"--gui", "-c", kConfig, "-i", held.rawlog, "-o", folder_.file("result"),
				"--instances", recorded_.rawlog, "--set", "odometry.file=" + recorded_.truth,
				"--set", "slam.frames_ahead=0"},
			folder_.file("out"), folder_.file("err"));
	}
	void waitAt(int frame) { held_.at(frame)->waitForReader(*program_); }
	void letGoOn(int frame) { held_.at(frame)->release(); }

	cv::Mat screen() const { return readXWindowDump(folder_.file("screen/Xvfb_screen0")); }
	/** Mean difference, of 255, between what is at the picture's place and the frame with its masks. */
	double differenceFrom(int frame) const
	{
		const cv::Mat now = screen();
		if (now.empty()) return 255;
		const View view = renderView(roomScene(16), smallCamera(), cameraOnCircle(frame * kStep));
		cv::Mat expected, difference;
		cv::resize(
			drawInstances(instancesOf(view, frame), view.frame.color), expected, kPicture.size(), 0,
			0, cv::INTER_NEAREST);
		cv::absdiff(now(kPicture), expected, difference);
		const cv::Scalar mean = cv::mean(difference);
		return (mean[0] + mean[1] + mean[2]) / 3;
	}
	/** From the frame before or after it, the difference is 3 at least. */
	bool shows(int frame) const { return differenceFrom(frame) < 1; }
	void waitUntilShown(int frame)
	{
		waitUntil(
			"frame " + std::to_string(frame) + " is shown",
			[&]
			{
				if (!program_->isRunning()) throw std::runtime_error("it ended: " + messages());
				return shows(frame);
			});
	}
	void press(const std::string& key) const
	{
		const std::string display = readBytes(folder_.file("screen/display"));
		const auto result = shell(
			"export DISPLAY=" + display.substr(0, display.find('\n')) +
				"; xdotool search --onlyvisible --name '^semloop-slam' windowfocus --sync key " +
				key,
			folder_.path());
		ASSERT_EQ(result.code, 0) << result.err;
	}

	RecordedRun recorded_;
	std::map<int, std::unique_ptr<HeldFile>> held_;
	std::unique_ptr<ChildProcess> program_;
};

/** Pixels of a colour of the room's objects, which all have the same red; light makes them brighter or
 *  darker. Paths, text and floor are pure blue or grey. */
int objectPixels(const cv::Mat& image)
{
	int count = 0;
	for (int v = 0; v < image.rows; ++v)
		for (int u = 0; u < image.cols; ++u)
		{
			const auto& p = image.at<cv::Vec3b>(v, u);
			const auto [low, high] = std::minmax({p[0], p[1], p[2]});
			count += high - low > 30 && p[2] > 40;
		}
	return count;
}

/** Pixels of the colour of path and camera; the camera alone has some 100. */
int pathPixels(const cv::Mat& image)
{
	cv::Mat mask;
	cv::inRange(image, cv::Scalar(195, 85, 0), cv::Scalar(205, 95, 5), mask);
	return cv::countNonZero(mask);
}
}  // namespace

TEST_F(SemloopSlamGui, ShowsPictureMapAndPathAndChangesNoResult)
{
	constexpr int kShown = 17;
	start({kShown, kShown + 1});
	waitAt(kShown);
	waitUntilShown(kShown - 1);
	// The map comes along a few times a second: with the next frame, then.
	std::this_thread::sleep_for(std::chrono::seconds(2));
	letGoOn(kShown);
	waitAt(kShown + 1);
	waitUntilShown(kShown);
	waitUntil(
		"objects and path are drawn",
		[&]
		{
			const cv::Mat map = screen()(kMap);
			return objectPixels(map) > 1000 && pathPixels(map) > 200;
		});
	letGoOn(kShown + 1);
	EXPECT_EQ(program_->exitCode(), 0) << messages();
	EXPECT_EQ(summary()["ended_by"], "end of the rawlog");
	EXPECT_EQ(summary()["frames"], recorded_.frames);

	const std::string shown = readBytes(folder_.file("result/objects.json"));
	ASSERT_EQ(run(arguments(recorded_)), 0) << messages();
	EXPECT_EQ(shown, readBytes(folder_.file("result/objects.json")));
}

TEST_F(SemloopSlamGui, PausesAndStepsByKeysAndCtrlCEndsThePause)
{
	if (!isInstalled("xdotool")) GTEST_SKIP() << "xdotool is not installed";
	constexpr int kHeld = 8;
	start({kHeld});
	waitAt(kHeld);
	waitUntilShown(kHeld - 1);
	const cv::Mat before = screen()(kButtons).clone();
	press("space");
	waitUntil(
		"the button says that it is paused",
		[&] { return cv::norm(before, screen()(kButtons), cv::NORM_INF) > 50; });
	letGoOn(kHeld);
	waitUntilShown(kHeld);
	std::this_thread::sleep_for(std::chrono::milliseconds(500));
	EXPECT_TRUE(shows(kHeld)) << "paused";
	press("s");
	waitUntilShown(kHeld + 1);
	press("Right");
	waitUntilShown(kHeld + 2);
	std::this_thread::sleep_for(std::chrono::milliseconds(500));
	EXPECT_TRUE(shows(kHeld + 2)) << "a step is one frame";

	program_->send(SIGINT);
	EXPECT_EQ(program_->exitCode(), 0) << messages();
	EXPECT_EQ(summary()["ended_by"], "Ctrl-C");
	EXPECT_EQ(summary()["frames"], kHeld + 3);
}

TEST_F(SemloopSlamFixture, WithoutADisplayTheGuiSaysInOneLineWhatToDo)
{
	const RecordedRun recorded = recordShortRun();
	EXPECT_EQ(
		shell(
			"env -u DISPLAY -u WAYLAND_DISPLAY '" + std::string(kProgram) + "' --gui " +
				arguments(recorded) + " 2> '" + folder_.file("err") + "'",
			folder_.path())
			.code,
		1);
	EXPECT_THAT(messages(), StartsWith("semloop-slam: --gui: "));
	EXPECT_THAT(messages(), HasSubstr("DISPLAY"));
	EXPECT_EQ(messageLines(), 1u);
}

TEST_F(SemloopSlamGui, ADisplayThatIsGoneEndsTheWindowAndNotTheRun)
{
	constexpr int kFrame = 12;
	start({kFrame});
	waitAt(kFrame);
	waitUntilShown(kFrame - 1);
	const auto killed = shell("kill $(cat screen/server)", folder_.path());
	ASSERT_EQ(killed.code, 0) << killed.err;
	waitUntil(
		"the window has noticed it",
		[&] { return messages().find("the display is gone") != std::string::npos; });
	letGoOn(kFrame);
	EXPECT_EQ(program_->exitCode(), 0) << messages();
	EXPECT_EQ(summary()["frames"], recorded_.frames);
}
