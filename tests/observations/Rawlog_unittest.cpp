#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include <filesystem>

#include "TemporaryFolder.h"
#include "TestScan.h"

using mrpt::obs::CObservationOdometry;
using semloop::InputError;
using semloop::RawlogReader;
using semloop::RawlogWriter;
using semloop::TemporaryFolder;

namespace
{
CObservationOdometry odometryAt(double seconds)
{
	CObservationOdometry o;
	o.timestamp = mrpt::Clock::fromDouble(seconds);
	o.sensorLabel = "ODO" + std::to_string(int(seconds));
	return o;
}

std::string writeRawlog(const TemporaryFolder& folder, int count)
{
	RawlogWriter writer(folder.file("a.rawlog"));
	for (int i = 0; i < count; i++) writer.write(odometryAt(i));
	writer.close();
	return folder.file("a.rawlog");
}

struct Read
{
	int count = 0;
	std::string error;
};

Read readAll(const std::string& path)
{
	Read result;
	result.error = semloop::messageOf<InputError>(
		[&]
		{
			RawlogReader reader(path);
			while (reader.next()) result.count++;
		});
	return result;
}

/** The same objects without compression. */
std::string plainCopy(const TemporaryFolder& folder, const std::string& path)
{
	mrpt::io::CFileGZInputStream in(path);
	std::string bytes(1 << 20, 0);
	bytes.resize(in.Read(bytes.data(), bytes.size()));
	return folder.write("plain.rawlog", bytes);
}

}  // namespace

TEST(Rawlog, ComesBackInTheOrderItWasWritten)
{
	const TemporaryFolder folder;
	RawlogReader reader(writeRawlog(folder, 20));
	for (int i = 0; i < 20; i++)
	{
		const auto observation = reader.next();
		ASSERT_TRUE(observation);
		EXPECT_EQ(observation->sensorLabel, "ODO" + std::to_string(i));
	}
	EXPECT_FALSE(reader.next());
	EXPECT_FALSE(reader.next());
	EXPECT_EQ(reader.progress(), 1.0);
}

TEST(Rawlog, AnEmptyRawlogHasNoObservation)
{
	const TemporaryFolder folder;
	const auto read = readAll(writeRawlog(folder, 0));
	EXPECT_EQ(read.count, 0);
	EXPECT_EQ(read.error, "");
}

TEST(Rawlog, IsReadByMrptsOwnLoader)
{
	const TemporaryFolder folder;
	mrpt::obs::CRawlog rawlog;
	ASSERT_TRUE(rawlog.loadFromRawLogFile(writeRawlog(folder, 5)));
	EXPECT_EQ(rawlog.size(), 5u);
}

TEST(Rawlog, PlainFilesAreReadToo)
{
	const TemporaryFolder folder;
	const auto read = readAll(plainCopy(folder, writeRawlog(folder, 5)));
	EXPECT_EQ(read.count, 5);
	EXPECT_EQ(read.error, "");
}

TEST(Rawlog, ObservationsOfSensoryFramesComeOneByOne)
{
	const TemporaryFolder folder;
	RawlogWriter writer(folder.file("frames.rawlog"));
	for (int i = 0; i < 3; i++)
	{
		mrpt::obs::CSensoryFrame frame;
		frame.insert(CObservationOdometry::Create(odometryAt(2 * i)));
		frame.insert(CObservationOdometry::Create(odometryAt(2 * i + 1)));
		writer.write(mrpt::obs::CActionCollection());
		writer.write(frame);
	}
	writer.close();
	RawlogReader reader(folder.file("frames.rawlog"));
	for (int i = 0; i < 6; i++) EXPECT_EQ(reader.next()->sensorLabel, "ODO" + std::to_string(i));
	EXPECT_FALSE(reader.next());
}

TEST(Rawlog, ACutAnywhereInACompressedFileIsTold)
{
	const TemporaryFolder folder;
	const auto whole = semloop::readBytes(writeRawlog(folder, 6));
	int last = 0;
	for (std::size_t length = 0; length < whole.size(); length++)
	{
		const auto read = readAll(folder.write("cut.rawlog", whole.substr(0, length)));
		ASSERT_NE(read.error, "") << "cut to " << length << " of " << whole.size();
		ASSERT_EQ(read.error.find(folder.file("cut.rawlog")), 0u) << read.error;
		ASSERT_EQ(read.error.find('\n'), std::string::npos);
		ASSERT_GE(read.count, last);  // what was read before stays good
		last = read.count;
	}
	EXPECT_EQ(last, 6);
}

TEST(Rawlog, ACutInsideAnObjectOfAPlainFileIsTold)
{
	const TemporaryFolder folder;
	const auto whole = semloop::readBytes(plainCopy(folder, writeRawlog(folder, 4)));
	const std::size_t object = whole.size() / 4;
	ASSERT_EQ(whole.size() % 4, 0u);
	for (std::size_t length = 1; length < whole.size(); length++)
	{
		const auto read = readAll(folder.write("cut.rawlog", whole.substr(0, length)));
		ASSERT_EQ(read.count, int(length / object)) << length;
		ASSERT_EQ(read.error.empty(), length % object == 0) << length << read.error;
	}
}

TEST(Rawlog, ADamagedByteIsToldAndNothingCrashes)
{
	const TemporaryFolder folder;
	const auto whole = semloop::readBytes(writeRawlog(folder, 6));
	const std::size_t gzHeader = 10;  // time and system there do not matter
	for (std::size_t place = gzHeader; place < whole.size(); place++)
	{
		auto bytes = whole;
		bytes[place] = char(bytes[place] ^ 0x55);
		const auto read = readAll(folder.write("damaged.rawlog", bytes));
		ASSERT_NE(read.error, "") << "byte " << place << " of " << whole.size();
	}
}

TEST(Rawlog, ADamagedByteInAPlainFileNeverCrashes)
{
	const TemporaryFolder folder;
	const auto whole = semloop::readBytes(plainCopy(folder, writeRawlog(folder, 3)));
	for (std::size_t place = 0; place < whole.size(); place++)
	{
		auto bytes = whole;
		bytes[place] = char(bytes[place] ^ 0x01);
		EXPECT_LE(readAll(folder.write("damaged.rawlog", bytes)).count, 3);
	}
}

TEST(Rawlog, AnUnknownClassIsNamedWithTheRemedy)
{
	const TemporaryFolder folder;
	const std::string name = "acme::CObservationSmell", frame = "mrpt::obs::CSensoryFrame";
	const std::string smell = char(name.size() | 0x80) + name + '\0' + '\x88';
	const std::string inFrame =
		char(frame.size() | 0x80) + frame + '\2' + std::string("\1\0\0\0", 4) + smell + '\x88';
	for (const auto& bytes : {smell, inFrame})
	{
		const auto path = folder.write("smell.rawlog", bytes);
		const auto read = readAll(path);
		EXPECT_EQ(read.error.find(path), 0u) << read.error;
		EXPECT_NE(read.error.find(name), std::string::npos) << read.error;
		EXPECT_NE(read.error.find("plug-in"), std::string::npos) << read.error;
		EXPECT_EQ(read.error.find('\n'), std::string::npos) << read.error;
	}
}

TEST(Rawlog, AnInstanceThatCannotBeIsTold)
{
	const TemporaryFolder folder;
	semloop::CObservationInstances good;
	good.camera.ncols = 8;
	good.camera.nrows = 6;
	good.labels = semloop::LabelSet({"cup"});
	good.instances.resize(1);
	good.instances[0].box = {0, 0, 8, 6};
	good.instances[0].mask = semloop::InstanceMask({8, 6});
	good.instances[0].labelScores = {{0, 0.25f}};
	RawlogWriter writer(folder.file("x.rawlog"));
	writer.write(good);
	writer.close();
	auto bytes = semloop::readBytes(plainCopy(folder, folder.file("x.rawlog")));
	const float score = 0.25f, impossible = 25.0f;
	const auto place =
		bytes.find(std::string(reinterpret_cast<const char*>(&score), sizeof(score)));
	ASSERT_NE(place, std::string::npos);
	bytes.replace(
		place, sizeof(score),
		std::string(reinterpret_cast<const char*>(&impossible), sizeof(score)));
	const auto read = readAll(folder.write("bad.rawlog", bytes));
	EXPECT_NE(read.error.find("instance 0: label score 25"), std::string::npos) << read.error;
}

TEST(Rawlog, AFileOfAnotherKindIsNotARawlog)
{
	const TemporaryFolder folder;
	for (const std::string text :
		 {"# timestamp filename\n1 a.png\n", "\x89PNG\r\n\x1a\n0000000", "\xff"})
		EXPECT_NE(readAll(folder.write("other.rawlog", text)).error, "");
	EXPECT_NE(readAll(folder.write("empty.rawlog", "")).error.find("empty"), std::string::npos);
	RawlogWriter writer(folder.file("pose.rawlog"));
	writer.write(mrpt::poses::CPose3D());
	writer.close();
	EXPECT_NE(readAll(folder.file("pose.rawlog")).error.find("CPose3D"), std::string::npos);
}

TEST(Rawlog, AMissingFileAndAFolderAreNamed)
{
	const TemporaryFolder folder;
	for (const auto& path : {folder.file("missing.rawlog"), folder.path().string()})
		EXPECT_EQ(readAll(path).error.find(path), 0u) << readAll(path).error;
}

TEST(Rawlog, TellsHowFarItIs)
{
	const TemporaryFolder folder;
	RawlogWriter writer(folder.file("long.rawlog"));
	cv::RNG random(1);
	for (int i = 0; i < 20; i++)
	{
		auto scan = semloop::makeScan();
		for (auto& value : scan->rangeImage) value = uint16_t(random());  // does not compress
		writer.write(*scan);
	}
	writer.close();
	RawlogReader reader(folder.file("long.rawlog"));
	double last = 0;
	for (int i = 0; i < 20; i++)
	{
		ASSERT_TRUE(reader.next());
		EXPECT_GE(reader.progress(), last);
		last = reader.progress();
		EXPECT_NEAR(last, (i + 1) / 20.0, 0.5);  // it reads up to 64 kB ahead, of 120
	}
}

TEST(Rawlog, AppearsUnderItsNameOnlyWhenClosed)
{
	const TemporaryFolder folder;
	const auto path = folder.file("b.rawlog");
	{
		RawlogWriter writer(path);
		writer.write(odometryAt(1));
		EXPECT_TRUE(std::filesystem::exists(RawlogWriter::partialPath(path)));
	}
	EXPECT_FALSE(std::filesystem::exists(path));
	EXPECT_EQ(readAll(RawlogWriter::partialPath(path)).count, 1);

	RawlogWriter writer(path);
	writer.close();
	EXPECT_TRUE(std::filesystem::exists(path));
	EXPECT_FALSE(std::filesystem::exists(RawlogWriter::partialPath(path)));
	EXPECT_THROW(writer.write(odometryAt(1)), std::logic_error);
}

TEST(Rawlog, TheSameObservationsGiveTheSameBytes)
{
	const TemporaryFolder folder;
	const auto first = semloop::readBytes(writeRawlog(folder, 7));
	EXPECT_EQ(semloop::readBytes(writeRawlog(folder, 7)), first);
}

TEST(Rawlog, AnObjectThatCannotBeWrittenLeavesNoTrace)
{
	const TemporaryFolder folder;
	semloop::CObservationInstances bad;
	bad.instances.resize(1);
	RawlogWriter writer(folder.file("c.rawlog"));
	writer.write(odometryAt(1));
	EXPECT_THROW(writer.write(bad), std::exception);
	writer.write(odometryAt(2));
	writer.close();
	const auto read = readAll(folder.file("c.rawlog"));
	EXPECT_EQ(read.count, 2);
	EXPECT_EQ(read.error, "");
}

TEST(Rawlog, AnUnwritablePlaceAndAFullDiskAreTold)
{
	EXPECT_THROW(RawlogWriter("/nonexistent/a.rawlog"), InputError);
	if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
	const TemporaryFolder folder;
	std::filesystem::create_symlink("/dev/full", folder.file("full.rawlog.partial"));
	RawlogWriter writer(folder.file("full.rawlog"));
	EXPECT_THROW(
		{
			writer.write(odometryAt(1));
			writer.close();
		},
		InputError);
	EXPECT_FALSE(std::filesystem::exists(folder.file("full.rawlog")));
}

TEST(Rawlog, NamesOfFoldersAndSidecarsFollowTheRawlogs)
{
	EXPECT_EQ(semloop::externalImagesFolder("/d/x.rawlog"), "/d/x_Images");
	EXPECT_EQ(semloop::externalImagesFolder("/d/x.rawlog.partial"), "/d/x_Images");
	EXPECT_EQ(semloop::externalImagesFolder("x"), "x_Images");
	EXPECT_EQ(semloop::instancesSidecarPath("/d/x.rawlog"), "/d/x_instances.rawlog");
}

TEST(Rawlog, ObjectsCanBeCopiedByteByByte)
{
	const TemporaryFolder folder;
	const std::string path = writeRawlog(folder, 3);
	RawlogReader reader(path);
	RawlogWriter writer(folder.file("copy.rawlog"));
	int count = 0;
	while (const auto object = reader.nextObject())
	{
		EXPECT_TRUE(std::dynamic_pointer_cast<CObservationOdometry>(object->object));
		writer.writeBytes(object->bytes);
		count++;
	}
	writer.close();
	EXPECT_EQ(count, 3);
	EXPECT_EQ(semloop::readBytes(folder.file("copy.rawlog")), semloop::readBytes(path));
}
