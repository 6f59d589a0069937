#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/config/Error.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>
#include <semloop/sensors/SensorRecorder.h>

#include <filesystem>
#include <string>

#include "TemporaryFolder.h"

using namespace semloop;
using mrpt::obs::CObservationOdometry;

namespace
{
CObservationOdometry::Ptr reading(int i)
{
	auto odometry = CObservationOdometry::Create();
	odometry->timestamp = mrpt::Clock::fromDouble(100 + i);
	odometry->odometry.x(i);
	return odometry;
}
}  // namespace

TEST(SensorRecorder, KeepsEverythingInOrderWhateverTheQueue)
{
	const TemporaryFolder folder;
	const std::string path = folder.file("x.rawlog");
	SensorRecorder recorder(path);
	for (int i = 0; i < 500; ++i) recorder.write(reading(i));
	EXPECT_FALSE(std::filesystem::exists(path));
	recorder.close();
	recorder.write(reading(500));  // too late, and no harm
	recorder.close();

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
	EXPECT_THROW(SensorRecorder(folder.file("missing/x.rawlog")), InputError);

	const std::string path = folder.file("full.rawlog");
	std::filesystem::create_symlink("/dev/full", RawlogWriter::partialPath(path));
	SensorRecorder recorder(path);
	// More than any buffer holds; after the error write() must not wait for ever.
	for (int i = 0; i < 20000; ++i) recorder.write(reading(i * 7919));
	EXPECT_THROW(recorder.close(), InputError);
}
