#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/SensorRecorder.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "TemporaryFolder.h"

using namespace semloop;
using mrpt::obs::CObservationOdometry;

namespace
{
struct News
{
	SensorRecorder::Report report()
	{
		return [this](const std::string& line)
		{
			const std::lock_guard lock(mutex);
			lines.push_back(line);
		};
	}
	std::vector<std::string> all()
	{
		const std::lock_guard lock(mutex);
		return lines;
	}

	std::mutex mutex;
	std::vector<std::string> lines;
};

CObservationOdometry::Ptr reading(int i)
{
	auto odometry = CObservationOdometry::Create();
	odometry->timestamp = mrpt::Clock::fromDouble(100 + i);
	odometry->odometry.x(i);
	return odometry;
}
}  // namespace

TEST(SensorRecorder, KeepsEverythingInOrder)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	News news;
	SensorRecorder recorder(path, news.report());
	for (int i = 0; i < 500; ++i) recorder.write(reading(i));
	EXPECT_FALSE(std::filesystem::exists(path));
	recorder.close();
	EXPECT_EQ(recorder.counts().recorded, 500u);
	EXPECT_EQ(recorder.counts().omitted, 0u);
	recorder.write(reading(500));  // too late, and no harm
	recorder.close();
	EXPECT_TRUE(news.all().empty());

	RawlogReader reader(path);
	for (int i = 0; i < 500; ++i)
	{
		const auto odometry = std::dynamic_pointer_cast<CObservationOdometry>(reader.next());
		ASSERT_TRUE(odometry);
		EXPECT_EQ(odometry->odometry.x(), i);
		EXPECT_EQ(odometry->timestamp, mrpt::Clock::fromDouble(100 + i));
	}
	EXPECT_FALSE(reader.next());
}

TEST(SensorRecorder, WhatCannotBeWrittenIsTold)
{
	const TemporaryFolder folder;
	News news;
	EXPECT_THROW(SensorRecorder(folder.file("missing/x.rawlog"), news.report()), InputError);

	const std::string path = folder.file("full.rawlog");
	std::filesystem::create_symlink("/dev/full", RawlogWriter::partialPath(path));
	SensorRecorder recorder(path, news.report());
	// More than any buffer holds; after the error write() must not wait for ever.
	for (int i = 0; i < 20000; ++i) recorder.write(reading(i * 7919));
	EXPECT_THROW(recorder.close(), InputError);
	EXPECT_THAT(
		news.all(), testing::Contains(testing::HasSubstr("the recording ends here: " + path)));
	EXPECT_GT(recorder.counts().omitted, 0u);
	EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(SensorRecorder, WithoutCloseThePartialFileStays)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	News news;
	{
		SensorRecorder recorder(path, news.report());
		recorder.write(reading(1));
	}
	EXPECT_FALSE(std::filesystem::exists(path));
	RawlogReader reader(RawlogWriter::partialPath(path));
	EXPECT_TRUE(reader.next());
}

TEST(SensorRecorder, NothingLeavesNoFile)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	News news;
	{
		SensorRecorder recorder(path, news.report());
		recorder.close();
	}
	EXPECT_FALSE(std::filesystem::exists(path));
	EXPECT_FALSE(std::filesystem::exists(RawlogWriter::partialPath(path)));
}

TEST(SensorRecorder, ADiskThatHangsIsNotWaitedFor)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	ASSERT_EQ(mkfifo(RawlogWriter::partialPath(path).c_str(), 0600), 0);
	// Whoever opens a pipe for writing waits for a reader: one that reads at the end only.
	const int reader = open(RawlogWriter::partialPath(path).c_str(), O_RDONLY | O_NONBLOCK);
	News news;
	SensorRecorder recorder(path, news.report());
	const auto image = mrpt::obs::CObservation3DRangeScan::Create();
	image->hasRangeImage = true;
	image->rangeImage_setSize(480, 640);
	for (int i = 0; i < 480 * 640; ++i)
		image->rangeImage.data()[i] = uint16_t(i * 7919);  // does not compress
	for (int i = 0; i < 200; ++i) recorder.write(image);
	EXPECT_GE(recorder.counts().omitted, 90u);
	EXPECT_THAT(news.all().at(0), testing::HasSubstr("does not keep up"));
	std::signal(SIGPIPE, SIG_IGN);
	close(reader);  // a broken pipe
	EXPECT_THROW(recorder.close(), InputError);
}
