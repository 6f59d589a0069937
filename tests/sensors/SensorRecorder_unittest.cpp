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

#include <chrono>
#include <csignal>
#include <filesystem>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "TemporaryFolder.h"

using namespace semloop;
using namespace std::chrono_literals;
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

/** Is being written until it is let go. */
struct HeldReading : CObservationOdometry
{
	void serializeTo(mrpt::serialization::CArchive& out) const override
	{
		started.set_value();
		letGo.get_future().wait();
		CObservationOdometry::serializeTo(out);
	}

	mutable std::promise<void> started, letGo;
};

/** A full pipe in the place of the partial file: whoever writes to it waits. */
class HangingDisk
{
public:
	explicit HangingDisk(const std::string& path)
	{
		const std::string pipe = RawlogWriter::partialPath(path);
		EXPECT_EQ(mkfifo(pipe.c_str(), 0600), 0);
		// Whoever opens a pipe for writing waits for a reader.
		reader_ = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
		const int writer = open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
		while (::write(writer, "x", 1) == 1)
			;
		::close(writer);
	}
	~HangingDisk() { fail(); }

	/** Ends the waiting, with an error: a broken pipe. */
	void fail()
	{
		std::signal(SIGPIPE, SIG_IGN);
		if (reader_ >= 0) ::close(std::exchange(reader_, -1));
	}

private:
	int reader_ = -1;
};
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
	HangingDisk disk(path);
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
	disk.fail();
	EXPECT_THROW(recorder.close(), InputError);
}

TEST(SensorRecorder, ADiskThatHangsWhileCompressionIsLeftOffIsNotWaitedFor)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	HangingDisk disk(path);
	News news;
	SensorRecorder recorder(path, news.report());
	const auto held = std::make_shared<HeldReading>();
	recorder.write(held);
	held->started.get_future().wait();
	// So many frames that compression is left off; zlib then writes the reading that it has kept.
	for (int i = 0; i < 20; ++i) recorder.write(mrpt::obs::CObservation3DRangeScan::Create());
	held->letGo.set_value();

	auto sensor = std::async(
		std::launch::async,
		[&]
		{
			while (recorder.counts().recorded == 0) std::this_thread::sleep_for(1ms);
			std::this_thread::sleep_for(100ms);  // until the recorder waits for the disk
			recorder.write(reading(1));
			return recorder.counts().recorded;
		});
	const bool returned = sensor.wait_for(10s) == std::future_status::ready;
	EXPECT_TRUE(returned);
	disk.fail();
	EXPECT_THROW(recorder.close(), InputError);
	// All would fit into zlib's buffer: the disk is waited for where the level changes.
	EXPECT_EQ(sensor.get(), 1u);
	EXPECT_EQ(recorder.counts().omitted, 21u);
}
