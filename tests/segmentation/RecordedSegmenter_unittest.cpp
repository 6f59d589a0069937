#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/rtti/CObject.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/segmentation/RecordedSegmenter.h>
#include <unistd.h>

#include <filesystem>

#include "TemporaryFolder.h"

namespace
{
using namespace semloop;
using testing::HasSubstr;

const cv::Size kImage(40, 30);

RgbdFrame frameAt(double seconds, cv::Size size = kImage)
{
	RgbdFrame frame;
	frame.time = mrpt::Clock::fromDouble(seconds);
	frame.color = cv::Mat(size, CV_8UC3);
	return frame;
}

class RecordedSegmenterTest : public testing::Test
{
protected:
	~RecordedSegmenterTest() override { std::filesystem::remove(path_); }

	/** Writes a sidecar with an observation without instances at each time, and opens it. */
	void record(const std::vector<double>& times)
	{
		RawlogWriter writer(path_);
		mrpt::obs::CObservationComment comment;
		comment.text = "passed over";
		writer.write(comment);
		for (const double time : times)
		{
			CObservationInstances observation;
			observation.timestamp = mrpt::Clock::fromDouble(time);
			observation.camera.ncols = uint32_t(kImage.width);
			observation.camera.nrows = uint32_t(kImage.height);
			observation.labels = LabelSet({"lamp"});
			writer.write(observation);
		}
		writer.close();
		mrpt::config::CConfigFileMemory config;
		config.write("segmentation", "file", path_);
		segmenter_.configure(config, "segmentation");
	}

	std::string errorAt(const RgbdFrame& frame)
	{
		try
		{
			segmenter_.segment(frame);
		}
		catch (const InputError& e)
		{
			return e.what();
		}
		return "no error";
	}

	std::string path_ = (std::filesystem::temp_directory_path() /
						 ("semloop-recorded" + std::to_string(getpid()) + ".rawlog"))
							.string();
	RecordedSegmenter segmenter_;
};

TEST_F(RecordedSegmenterTest, GivesEachFrameTheEntryOfItsTime)
{
	record({1.0, 1.1, 1.2});
	for (const double time : {1.0, 1.1, 1.2})
	{
		const auto found = segmenter_.segment(frameAt(time));
		ASSERT_TRUE(found) << time;
		EXPECT_EQ(found->timestamp, mrpt::Clock::fromDouble(time));
	}
	EXPECT_FALSE(segmenter_.segment(frameAt(1.3)));
	EXPECT_FALSE(segmenter_.segment(frameAt(1.4)));
}

TEST_F(RecordedSegmenterTest, FramesWithoutAnEntryGetNone)
{
	record({1.0, 1.3});
	EXPECT_FALSE(segmenter_.segment(frameAt(0.9)));
	EXPECT_TRUE(segmenter_.segment(frameAt(1.0)));
	EXPECT_FALSE(segmenter_.segment(frameAt(1.1)));
	EXPECT_FALSE(segmenter_.segment(frameAt(1.2)));
	EXPECT_TRUE(segmenter_.segment(frameAt(1.3)));
}

TEST_F(RecordedSegmenterTest, EntriesThatNoFrameAsksForArePassedOver)
{
	record({1.0, 1.1, 1.2, 1.3});
	EXPECT_TRUE(segmenter_.segment(frameAt(1.2)));
}

TEST_F(RecordedSegmenterTest, AMillisecondIsTheTolerance)
{
	record({1.0, 2.0, 3.0});
	EXPECT_TRUE(segmenter_.segment(frameAt(0.9991)));
	EXPECT_TRUE(segmenter_.segment(frameAt(2.0009)));
	EXPECT_FALSE(segmenter_.segment(frameAt(2.998)));
	EXPECT_FALSE(segmenter_.segment(frameAt(3.002)));
}

TEST_F(RecordedSegmenterTest, ACameraThatPlaysTheRecordingMayBeOffByMore)
{
	record({1.0, 1.1, 1.2});
	RecordedSegmenterOptions options;
	options.file = path_;
	options.maxTimeDifference = 0.04;
	segmenter_.configure(options);
	const auto early = segmenter_.segment(frameAt(0.97)), late = segmenter_.segment(frameAt(1.13));
	ASSERT_TRUE(early && late);
	// They are the frame's now.
	EXPECT_EQ(early->timestamp, frameAt(0.97).time);
	EXPECT_EQ(late->timestamp, frameAt(1.13).time);
	// An entry is of one frame.
	EXPECT_FALSE(segmenter_.segment(frameAt(1.135)));
	EXPECT_TRUE(segmenter_.segment(frameAt(1.2)));
}

TEST_F(RecordedSegmenterTest, ASizeThatDoesNotFitIsAnErrorWithFileTimeAndBothSizes)
{
	record({1.25});
	EXPECT_THAT(
		errorAt(frameAt(1.25, {80, 60})),
		testing::AllOf(
			HasSubstr(path_), HasSubstr("1.25"), HasSubstr("40x30"), HasSubstr("80x60")));
}

TEST_F(RecordedSegmenterTest, TimeGoingBackwardsIsAnError)
{
	record({1.0, 3.0, 2.0});
	EXPECT_TRUE(segmenter_.segment(frameAt(1.0)));
	EXPECT_THAT(errorAt(frameAt(0.5)), HasSubstr("in order of time"));
	EXPECT_THAT(errorAt(frameAt(3.5)), HasSubstr("come after those at 3.0"));
}

TEST_F(RecordedSegmenterTest, ACutFileGivesWhatItHasAndThenAnError)
{
	record({1.0, 1.1, 1.2});
	std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 20);
	RecordedSegmenterOptions options;
	options.file = path_;
	segmenter_.configure(options);
	std::string error = "no error";
	for (const double time : {1.0, 1.1, 1.2, 1.3})
		if (error == "no error") error = errorAt(frameAt(time));
	EXPECT_THAT(error, HasSubstr(path_));
}

TEST_F(RecordedSegmenterTest, AMissingFileOrKeyIsAnError)
{
	mrpt::config::CConfigFileMemory config;
	EXPECT_THROW(segmenter_.configure(config, "segmentation"), UsageError);
	config.write("segmentation", "file", "/no/such/file.rawlog");
	EXPECT_THAT(
		messageOf<InputError>([&] { segmenter_.configure(config, "segmentation"); }),
		testing::AllOf(HasSubstr("/no/such/file.rawlog"), HasSubstr("rawlog-segment")));
	EXPECT_THROW(RecordedSegmenter().segment(frameAt(1.0)), UsageError);
}

TEST(RecordedSegmenter, IsMadeByItsName)
{
	const auto made = mrpt::rtti::classFactory("semloop::RecordedSegmenter");
	EXPECT_TRUE(std::dynamic_pointer_cast<Segmenter>(made));
}

}  // namespace
