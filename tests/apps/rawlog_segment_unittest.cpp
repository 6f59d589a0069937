#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "HeldFile.h"
#include "TinyOnnx.h"

namespace
{
using namespace semloop;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::string contentOf(const fs::path& path)
{
	std::ifstream file(path, std::ios::binary);
	return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/** A range scan of 64 x 32 whose depth is 1 m everywhere. */
mrpt::obs::CObservation3DRangeScan scanAt(double seconds)
{
	mrpt::obs::CObservation3DRangeScan scan;
	scan.timestamp = mrpt::Clock::fromDouble(seconds);
	scan.sensorPose = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6);
	scan.hasRangeImage = true;
	scan.range_is_depth = true;
	scan.rangeUnits = 1.0f / 5000;
	scan.rangeImage_setSize(32, 64);
	scan.rangeImage.setConstant(5000);
	scan.hasIntensityImage = true;
	const cv::Mat color(32, 64, CV_8UC3, cv::Scalar(20, 40, 200));
	scan.intensityImage = mrpt::img::CImage(color, mrpt::img::DEEP_COPY);
	mrpt::img::TCamera camera;
	camera.ncols = 64;
	camera.nrows = 32;
	camera.setIntrinsicParamsFromValues(60, 60, 31.5, 15.5);
	scan.cameraParams = scan.cameraParamsIntensity = camera;
	scan.relativePoseIntensityWRTDepth = mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
	return scan;
}

/** A folder with a rawlog of five frames and the tiny networks, gone after the test. */
class RawlogSegment : public testing::Test
{
protected:
	RawlogSegment()
	{
		fs::create_directories(folder_);
		writeRawlog({0, 1, 2, 3, 4});
		test::writeFile(folder_ / "tiny.onnx", test::tinyYoloSeg());
		test::writeFile(folder_ / "embedding.onnx", test::tinyEmbedding());
		test::writeFile(folder_ / "labels.txt", "lamp\nvase\n");
	}
	~RawlogSegment() override { fs::remove_all(folder_); }

	void writeRawlog(const std::vector<double>& times)
	{
		RawlogWriter writer((folder_ / "in.rawlog").string());
		for (const double time : times) writer.write(scanAt(time));
		writer.close();
	}

	/** Exit code of the program with these arguments behind the usual ones. */
	int run(const std::string& arguments, const std::string& usual = kUsual)
	{
		const std::string command = "cd " + folder_.string() +
									"; " SEMLOOP_BINARY_DIR "/bin/rawlog-segment " + usual +
									" > out.txt 2> err.txt " + arguments;
		const int status = std::system(command.c_str());
		return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
	}
	std::string out() const { return contentOf(folder_ / "out.txt"); }
	std::string errors() const { return contentOf(folder_ / "err.txt"); }

	std::vector<CObservationInstances::Ptr> read(const std::string& name) const
	{
		std::vector<CObservationInstances::Ptr> result;
		RawlogReader reader((folder_ / name).string());
		while (const auto observation = reader.next())
			if (auto instances = std::dynamic_pointer_cast<CObservationInstances>(observation))
				result.push_back(instances);
		return result;
	}

	static constexpr const char* kUsual =
		"in.rawlog --model tiny.onnx --labels labels.txt --set segmentation.min_area=1";
	fs::path folder_ = fs::temp_directory_path() /
					   ("semloop-segment-" +
						std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
						std::to_string(getpid()));
};

TEST_F(RawlogSegment, WritesASidecarWithTheInstancesOfEveryFrame)
{
	ASSERT_EQ(run("--embedding-model embedding.onnx"), 0) << errors();
	EXPECT_THAT(out(), HasSubstr("in_instances.rawlog: 5 frames, 0 skipped, 10 instances"));
	EXPECT_THAT(out(), HasSubstr("5 lamp"));
	EXPECT_THAT(out(), HasSubstr("5 vase"));

	const auto found = read("in_instances.rawlog");
	ASSERT_EQ(found.size(), 5u);
	EXPECT_EQ(found[3]->timestamp, mrpt::Clock::fromDouble(3));
	EXPECT_EQ(found[3]->sensorPose, mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6));
	EXPECT_EQ(found[3]->imageSize(), cv::Size(64, 32));
	ASSERT_EQ(found[3]->instances.size(), 2u);
	const auto& lamp = found[3]->instances[0];
	EXPECT_EQ(lamp.mask.area(), 256u);
	EXPECT_FALSE(lamp.depth);
	// B, G, R = 20, 40, 200 less 127.5, in R, G, B; half floats keep three digits.
	const double r = 72.5, g = -87.5, b = -107.5, length = std::hypot(r, g, b);
	ASSERT_EQ(lamp.embedding.size(), 3u);
	EXPECT_NEAR(lamp.embedding[0], r / length, 1e-3);
	EXPECT_NEAR(lamp.embedding[1], g / length, 1e-3);
	EXPECT_NEAR(lamp.embedding[2], b / length, 1e-3);
}

TEST_F(RawlogSegment, WithoutAnEmbeddingNetworkItTakesColourHistograms)
{
	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_EQ(read("in_instances.rawlog").at(0)->instances.at(0).embedding.size(), 400u);
}

TEST_F(RawlogSegment, DepthCropsAreTheScansOwnValues)
{
	ASSERT_EQ(run("--depth-crops --out crops.rawlog"), 0) << errors();
	const auto found = read("crops.rawlog");
	const auto& lamp = found.at(0)->instances.at(0);
	ASSERT_TRUE(lamp.depth);
	EXPECT_EQ(lamp.depth->depth.size(), lamp.box.size());
	EXPECT_EQ(cv::countNonZero(lamp.depth->depth != 5000), 0);
	EXPECT_FLOAT_EQ(lamp.depth->unit, 1.0f / 5000);
}

TEST_F(RawlogSegment, EveryNthFrameAndTheLowestScoreCanBeChosen)
{
	ASSERT_EQ(run("--every 2 --score 0.7"), 0) << errors();
	const auto found = read("in_instances.rawlog");
	ASSERT_EQ(found.size(), 3u);
	EXPECT_EQ(found[1]->timestamp, mrpt::Clock::fromDouble(2));
	EXPECT_EQ(found[1]->instances.size(), 1u);
}

TEST_F(RawlogSegment, ACompleteSidecarIsNotMadeAgain)
{
	ASSERT_EQ(run(""), 0) << errors();
	const auto before = contentOf(folder_ / "in_instances.rawlog");
	const auto time = fs::last_write_time(folder_ / "in_instances.rawlog");
	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_THAT(errors(), HasSubstr("is there already"));
	EXPECT_THAT(out(), HasSubstr("5 frames, 0 skipped, 10 instances"));
	EXPECT_EQ(fs::last_write_time(folder_ / "in_instances.rawlog"), time);

	ASSERT_EQ(run("--force"), 0) << errors();
	EXPECT_EQ(contentOf(folder_ / "in_instances.rawlog"), before) << "the same run, the same bytes";
}

TEST_F(RawlogSegment, ASidecarOfOtherSettingsIsOnlyReplacedByForce)
{
	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_EQ(run("--score 0.7"), 1);
	EXPECT_THAT(errors(), HasSubstr("segmentation/min_score was \"0.25\", now \"0.7\""));
	EXPECT_EQ(read("in_instances.rawlog").at(0)->instances.size(), 2u);
	EXPECT_EQ(run("--score 0.7 --force"), 0) << errors();
	EXPECT_EQ(read("in_instances.rawlog").at(0)->instances.size(), 1u);
}

TEST_F(RawlogSegment, AnInterruptedRunGoesOnWhereItStopped)
{
	ASSERT_EQ(run(""), 0) << errors();
	const auto whole = contentOf(folder_ / "in_instances.rawlog");

	// What a killed run leaves: the settings, two frames (one of them marked) and half a third one.
	RawlogWriter writer((folder_ / "in_instances.rawlog").string());
	RawlogReader reader((folder_ / "in_instances.rawlog").string());
	for (int i = 0; i < 4; i++)
	{
		const auto observation = reader.next();
		if (i == 1)
			std::dynamic_pointer_cast<CObservationInstances>(observation)->instances.pop_back();
		writer.write(*observation);
	}
	writer.close();
	fs::rename(folder_ / "in_instances.rawlog", folder_ / "in_instances.rawlog.partial");
	const auto size = fs::file_size(folder_ / "in_instances.rawlog.partial");
	fs::resize_file(folder_ / "in_instances.rawlog.partial", size - 30);

	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_THAT(errors(), HasSubstr("goes on after"));
	const auto found = read("in_instances.rawlog");
	ASSERT_EQ(found.size(), 5u);
	EXPECT_EQ(found[0]->instances.size(), 1u) << "taken over, not computed again";
	for (int i = 1; i < 5; i++) EXPECT_EQ(found[std::size_t(i)]->instances.size(), 2u);
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog.partial"));
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog.previous"));
}

/** The program waits for the colour image of the third of five frames. */
class RawlogSegmentInterrupted : public RawlogSegment
{
protected:
	RawlogSegmentInterrupted()
	{
		const std::string held = path("held.png");
		RawlogWriter writer(path("in.rawlog"));
		for (int i = 0; i < 5; i++)
		{
			auto scan = scanAt(i);
			if (i == 2)
			{
				std::vector<uint8_t> png;
				cv::imencode(".png", scan.intensityImage.asCvMatRef(), png);
				image_ = std::make_unique<HeldFile>(held, std::string(png.begin(), png.end()));
				scan.intensityImage.setExternalStorage(held);
			}
			writer.write(scan);
		}
		writer.close();
		program_ = std::make_unique<ChildProcess>(
			std::vector<std::string>{
				SEMLOOP_BINARY_DIR "/bin/rawlog-segment", path("in.rawlog"), "--model",
				path("tiny.onnx"), "--labels", path("labels.txt"), "--set",
				"segmentation.min_area=1"},
			path("out.txt"), path("err.txt"));
		image_->waitForReader(*program_);
	}

	std::string path(const std::string& name) const { return (folder_ / name).string(); }
	/** Returns when the program has noticed it. */
	void pressCtrlC()
	{
		ASSERT_TRUE(program_->catches(SIGINT));
		program_->send(SIGINT);
		waitUntil("Ctrl-C is noticed", [&] { return !program_->catches(SIGINT); });
	}

	std::unique_ptr<HeldFile> image_;
	std::unique_ptr<ChildProcess> program_;
};

TEST_F(RawlogSegmentInterrupted, FinishesTheFrameSaysHowToGoOnAndGoesOnFromThere)
{
	pressCtrlC();
	image_->release();
	EXPECT_EQ(program_->exitCode(), 1);
	EXPECT_THAT(errors(), HasSubstr("stopped after 3 frames"));
	EXPECT_THAT(errors(), HasSubstr("run the same command again"));
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog"));
	EXPECT_EQ(read("in_instances.rawlog.partial").size(), 3u);

	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_THAT(errors(), HasSubstr("goes on after 3 frames"));
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog.partial"));
	ASSERT_EQ(run("--out whole.rawlog"), 0) << errors();
	EXPECT_EQ(contentOf(folder_ / "in_instances.rawlog"), contentOf(folder_ / "whole.rawlog"))
		<< "as if it had not been interrupted";
}

TEST_F(RawlogSegmentInterrupted, ASecondTimeStopsAtOnceAndTheNextRunDoesTheRest)
{
	pressCtrlC();
	program_->send(SIGINT);
	EXPECT_EQ(program_->killedBy(), SIGINT);
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog"));
	image_->makePlain();
	ASSERT_EQ(run(""), 0) << errors();
	EXPECT_EQ(read("in_instances.rawlog").size(), 5u);
}

TEST_F(RawlogSegment, ADamagedFrameIsSkippedWithAWarningAndCounted)
{
	RawlogWriter writer((folder_ / "in.rawlog").string());
	writer.write(scanAt(0));
	auto damaged = scanAt(1);
	damaged.hasIntensityImage = false;
	writer.write(damaged);
	writer.write(scanAt(2));
	writer.write(scanAt(1.5));
	writer.close();
	EXPECT_EQ(run(""), 0);
	EXPECT_THAT(errors(), HasSubstr("warning: frame 1 at 1."));
	EXPECT_THAT(errors(), HasSubstr("warning: frame 3 at 1.5"));
	EXPECT_THAT(out(), HasSubstr("2 frames, 2 skipped, 4 instances"));
}

TEST_F(RawlogSegment, ACutRawlogKeepsWhatWasReadAndFails)
{
	fs::resize_file(folder_ / "in.rawlog", fs::file_size(folder_ / "in.rawlog") - 40);
	EXPECT_EQ(run(""), 1);
	EXPECT_THAT(errors(), HasSubstr("in.rawlog: object 4"));
	EXPECT_EQ(read("in_instances.rawlog").size(), 4u);
}

TEST_F(RawlogSegment, ARawlogWithoutRangeScansIsAnError)
{
	RawlogWriter writer((folder_ / "in.rawlog").string());
	mrpt::obs::CObservationComment comment;
	writer.write(comment);
	writer.close();
	EXPECT_EQ(run(""), 1);
	EXPECT_THAT(errors(), HasSubstr("holds no CObservation3DRangeScan"));
	EXPECT_FALSE(fs::exists(folder_ / "in_instances.rawlog"));
}

TEST_F(RawlogSegment, AFileThatIsNoSidecarIsNotOverwritten)
{
	fs::copy(folder_ / "in.rawlog", folder_ / "in_instances.rawlog");
	EXPECT_EQ(run(""), 1);
	EXPECT_THAT(errors(), HasSubstr("did not write"));
	EXPECT_EQ(contentOf(folder_ / "in.rawlog"), contentOf(folder_ / "in_instances.rawlog"));
}

TEST_F(RawlogSegment, WrongUsageEndsWithTwoAndMissingFilesWithOne)
{
	EXPECT_EQ(run("", ""), 2);
	EXPECT_EQ(run("--every 0"), 2);
	EXPECT_EQ(run("--score 3"), 2);
	EXPECT_EQ(run("--set nonsense"), 2);
	EXPECT_EQ(run("--force --out ./in.rawlog"), 2) << "the rawlog itself";
	EXPECT_EQ(run("--set segmentation.no_such_key=1"), 2);
	EXPECT_THAT(errors(), HasSubstr("no_such_key"));
	EXPECT_EQ(run("--help"), 0);
	EXPECT_EQ(run("", "missing.rawlog --model tiny.onnx"), 1);
	EXPECT_THAT(errors(), HasSubstr("missing.rawlog: no such file"));
	EXPECT_EQ(run("", "in.rawlog --model missing.onnx"), 1);
	EXPECT_EQ(run("", "in.rawlog --model embedding.onnx"), 1);
	EXPECT_THAT(errors(), HasSubstr("not a segmentation network"));
	EXPECT_EQ(run("--set segmentation.input_width=640 --set segmentation.input_height=480"), 1);
	EXPECT_THAT(errors(), AllOf(HasSubstr("64x32"), HasSubstr("640x480")));
	EXPECT_EQ(run("--out /no/such/folder/out.rawlog"), 1);
	EXPECT_THAT(errors(), HasSubstr("/no/such/folder/out.rawlog"));
}

}  // namespace
