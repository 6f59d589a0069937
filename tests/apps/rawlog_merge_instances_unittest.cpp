#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include <filesystem>
#include <vector>

#include "Shell.h"
#include "TwoInstances.h"

namespace
{
using namespace semloop;
using mrpt::obs::CObservation3DRangeScan;
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

/** The bytes of the objects, whatever the compression. */
std::string uncompressed(const std::string& path)
{
	mrpt::io::CFileGZInputStream file(path);
	std::string bytes;
	for (std::string block(1 << 16, 0);;)
	{
		const auto got = file.Read(block.data(), block.size());
		bytes.append(block, 0, got);
		if (got < block.size()) return bytes;
	}
}

mrpt::obs::CObservationOdometry odometryAt(double seconds)
{
	mrpt::obs::CObservationOdometry odometry;
	odometry.timestamp = mrpt::Clock::fromDouble(seconds);
	odometry.sensorLabel = "ODO";
	return odometry;
}

CObservation3DRangeScan::Ptr scanAt(double seconds)
{
	auto scan = CObservation3DRangeScan::Create();
	scan->timestamp = mrpt::Clock::fromDouble(seconds);
	scan->sensorLabel = "RGBD";
	return scan;
}

/** rawlog-merge-instances, the program, in a folder of its own. */
class RawlogMergeInstances : public testing::Test
{
protected:
	/** Scans at 1 ... 4 s, odometry half a second before each. */
	RawlogMergeInstances()
	{
		RawlogWriter writer(folder_.file("in.rawlog"));
		for (const double time : {1, 2, 3, 4})
		{
			writer.write(odometryAt(time - 0.5));
			writer.write(*scanAt(time));
		}
		writer.close();
	}

	void writeSidecar(const std::vector<double>& times, bool withHeader = true) const
	{
		RawlogWriter writer(folder_.file("in_instances.rawlog"));
		mrpt::obs::CObservationComment header;
		header.text = R"({"format": "semloop.instances/1"})";
		header.timestamp = mrpt::Clock::fromDouble(1);
		if (withHeader) writer.write(header);
		for (const double time : times) writer.write(twoInstances(time));
		writer.close();
	}

	ShellResult run(const std::string& arguments) const
	{
		return shell(
			"'" SEMLOOP_BINARY_DIR "/bin/rawlog-merge-instances' " + arguments, folder_.path());
	}

	/** Class without its namespace and time of each observation. */
	std::vector<std::string> contents(const std::string& name) const
	{
		std::vector<std::string> result;
		RawlogReader reader(folder_.file(name));
		while (const auto observation = reader.next())
		{
			const std::string className = observation->GetRuntimeClass()->className;
			std::ostringstream entry;
			entry << className.substr(className.rfind(':') + 13) << " "
				  << mrpt::Clock::toDouble(observation->timestamp);
			result.push_back(entry.str());
		}
		return result;
	}

	TemporaryFolder folder_;
};

TEST_F(RawlogMergeInstances, PutsInstancesRightBehindTheirScans)
{
	writeSidecar({2, 4});
	const auto result = run("in.rawlog out.rawlog");
	ASSERT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(result.out, "out.rawlog: 8 objects and 2 observations of instances\n");
	EXPECT_THAT(
		contents("out.rawlog"),
		ElementsAre(
			"Odometry 0.5", "3DRangeScan 1", "Odometry 1.5", "3DRangeScan 2", "Comment 1",
			"Instances 2", "Odometry 2.5", "3DRangeScan 3", "Odometry 3.5", "3DRangeScan 4",
			"Instances 4"));
}

TEST_F(RawlogMergeInstances, SplittingGivesBothFilesBackBitByBit)
{
	writeSidecar({1, 2, 4});
	ASSERT_EQ(run("in.rawlog merged.rawlog").code, 0);
	const auto result = run("--split merged.rawlog back.rawlog");
	ASSERT_EQ(result.code, 0) << result.err;
	EXPECT_EQ(
		result.out,
		"back.rawlog: 8 objects without 3 observations of instances, which are in "
		"back_instances.rawlog\n");
	EXPECT_EQ(uncompressed(folder_.file("back.rawlog")), uncompressed(folder_.file("in.rawlog")));
	EXPECT_EQ(
		uncompressed(folder_.file("back_instances.rawlog")),
		uncompressed(folder_.file("in_instances.rawlog")));
}

TEST_F(RawlogMergeInstances, SensoryFramesStayWholeAndComeBackBitByBit)
{
	RawlogWriter writer(folder_.file("in.rawlog"));
	for (const double time : {1, 2})
	{
		mrpt::obs::CSensoryFrame frame;
		frame.insert(scanAt(time));
		writer.write(mrpt::obs::CActionCollection());
		writer.write(frame);
	}
	writer.close();
	writeSidecar({1, 2}, false);
	ASSERT_EQ(run("in.rawlog merged.rawlog").code, 0);
	EXPECT_THAT(
		contents("merged.rawlog"),
		ElementsAre("3DRangeScan 1", "Instances 1", "3DRangeScan 2", "Instances 2"));
	ASSERT_EQ(run("--split merged.rawlog back.rawlog").code, 0);
	EXPECT_EQ(uncompressed(folder_.file("back.rawlog")), uncompressed(folder_.file("in.rawlog")));
}

TEST_F(RawlogMergeInstances, TheImagesAreFoundFromTheNewName)
{
	writeSidecar({1});
	folder_.write("in_Images/color.jpg", "an image");
	ASSERT_EQ(run("in.rawlog out.rawlog").code, 0);
	EXPECT_TRUE(fs::is_symlink(folder_.path() / "out_Images"));
	EXPECT_EQ(readBytes(folder_.file("out_Images/color.jpg")), "an image");
}

TEST_F(RawlogMergeInstances, ImagesOfAnotherRecordingUnderTheNewNameAreNotTakenForIts)
{
	writeSidecar({1});
	folder_.write("in_Images/color.jpg", "an image");
	folder_.write("other_Images/color.jpg", "another image");
	fs::create_directory_symlink("other_Images", folder_.path() / "out_Images");
	const auto result = run("in.rawlog out.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("out_Images: is a link to other images already"));
	EXPECT_FALSE(fs::exists(folder_.path() / "out.rawlog"));
	EXPECT_EQ(run("--force in.rawlog out.rawlog").code, 0);
	EXPECT_EQ(readBytes(folder_.file("out_Images/color.jpg")), "an image");
	EXPECT_EQ(readBytes(folder_.file("other_Images/color.jpg")), "another image");

	const auto folder = run("--force in.rawlog other.rawlog");
	EXPECT_EQ(folder.code, 1);
	EXPECT_THAT(folder.err, HasSubstr("other_Images: is there already and not in_Images"));
	EXPECT_EQ(readBytes(folder_.file("other_Images/color.jpg")), "another image");
}

TEST_F(RawlogMergeInstances, WhatAnInterruptedRunLeftIsNotReplacedUnasked)
{
	writeSidecar({1});
	ASSERT_EQ(run("in.rawlog merged.rawlog").code, 0);
	folder_.write("back_instances.rawlog.partial", "precious");
	const auto result = run("--split merged.rawlog back.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("back_instances.rawlog.partial: is there already"));
	EXPECT_EQ(readBytes(folder_.file("back_instances.rawlog.partial")), "precious");
}

TEST_F(RawlogMergeInstances, TwoOutputsOfOneNameAreRefusedBeforeTheyExist)
{
	writeSidecar({1});
	ASSERT_EQ(run("in.rawlog merged.rawlog").code, 0);
	const auto result = run("--split merged.rawlog new.rawlog --instances ./new.rawlog");
	EXPECT_EQ(result.code, 2);
	EXPECT_THAT(result.err, HasSubstr("./new.rawlog: cannot be rawlog and sidecar at once"));
}

TEST_F(RawlogMergeInstances, WhatIsNoRawlogReplacesNothing)
{
	writeSidecar({1});
	ASSERT_EQ(run("in.rawlog out.rawlog").code, 0);
	const std::string good = readBytes(folder_.file("out.rawlog"));
	folder_.write("text.rawlog", "hello");
	for (const std::string arguments :
		 {"in.rawlog out.rawlog --instances text.rawlog",
		  "text.rawlog out.rawlog --instances in_instances.rawlog"})
	{
		const auto result = run("--force " + arguments);
		EXPECT_EQ(result.code, 1);
		EXPECT_THAT(result.err, HasSubstr("text.rawlog: object 0"));
		EXPECT_EQ(readBytes(folder_.file("out.rawlog")), good);
		EXPECT_FALSE(fs::exists(folder_.path() / "out.rawlog.partial"));
	}
}

TEST_F(RawlogMergeInstances, ScansOutOfOrderAreRefusedAndNotDropped)
{
	RawlogWriter writer(folder_.file("in.rawlog"));
	for (const double time : {1, 3, 2}) writer.write(*scanAt(time));
	writer.close();
	writeSidecar({1, 3});
	const auto result = run("--leave-out in.rawlog out.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("the range scan of 2.000000 s comes behind one of 3.000000"));
}

TEST_F(RawlogMergeInstances, WithoutInstancesThereIsNothingToSplit)
{
	const auto result = run("--split in.rawlog back.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_EQ(
		result.err,
		"rawlog-merge-instances: in.rawlog: has no instances that could be taken out\n");
	for (const char* const left : {"back.rawlog", "back.rawlog.partial", "back_instances.rawlog"})
		EXPECT_FALSE(fs::exists(folder_.path() / left)) << left;
}

TEST_F(RawlogMergeInstances, InstancesInsideSensoryFramesAreSeen)
{
	RawlogWriter writer(folder_.file("in.rawlog"));
	mrpt::obs::CSensoryFrame frame;
	frame.insert(scanAt(1));
	frame.insert(std::make_shared<CObservationInstances>(twoInstances(1)));
	writer.write(mrpt::obs::CActionCollection());
	writer.write(frame);
	writer.close();
	writeSidecar({1});
	const auto merge = run("in.rawlog out.rawlog");
	EXPECT_EQ(merge.code, 1);
	EXPECT_THAT(merge.err, HasSubstr("has instances already, in its sensory frames"));
	const auto split = run("--split in.rawlog out.rawlog");
	EXPECT_EQ(split.code, 1);
	EXPECT_THAT(split.err, HasSubstr("has instances in sensory frames"));
}

TEST_F(RawlogMergeInstances, AHeaderThatRemovedInstancesLeftIsDropped)
{
	writeSidecar({1, 2});
	RawlogWriter writer(folder_.file("in2.rawlog"));
	mrpt::obs::CObservationComment header;
	header.text = R"({"format": "semloop.instances/1"})";
	writer.write(header);
	for (const double time : {1, 2}) writer.write(*scanAt(time));
	writer.close();
	ASSERT_EQ(run("in2.rawlog merged.rawlog --instances in_instances.rawlog").code, 0);
	ASSERT_EQ(run("--split merged.rawlog back.rawlog").code, 0);
	EXPECT_THAT(contents("back.rawlog"), ElementsAre("3DRangeScan 1", "3DRangeScan 2"));
	EXPECT_EQ(
		uncompressed(folder_.file("back_instances.rawlog")),
		uncompressed(folder_.file("in_instances.rawlog")));
}

TEST_F(RawlogMergeInstances, ASidecarOfAnotherRecordingIsRefused)
{
	writeSidecar({1, 2.25, 3});
	const auto result = run("in.rawlog out.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_EQ(
		result.err,
		"rawlog-merge-instances: in_instances.rawlog: in.rawlog has no range scan of 2.250000 s: "
		"is it "
		"the sidecar of this rawlog? --leave-out merges the others\n");
	EXPECT_FALSE(fs::exists(folder_.path() / "out.rawlog"));
	EXPECT_FALSE(fs::exists(folder_.path() / "out.rawlog.partial"));

	const auto others = run("--leave-out in.rawlog out.rawlog");
	EXPECT_EQ(others.code, 0);
	EXPECT_EQ(
		others.out,
		"out.rawlog: 8 objects and 2 observations of instances; 1 without a scan of their time "
		"left "
		"out\n");
}

TEST_F(RawlogMergeInstances, NothingIsReplacedUnasked)
{
	writeSidecar({1});
	folder_.write("out.rawlog", "precious");
	const auto result = run("in.rawlog out.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_EQ(
		result.err,
		"rawlog-merge-instances: out.rawlog: is there already; name another or add --force\n");
	EXPECT_EQ(readBytes(folder_.file("out.rawlog")), "precious");
	EXPECT_EQ(run("--force in.rawlog out.rawlog").code, 0);
	EXPECT_EQ(run("--force in.rawlog in.rawlog").code, 2);
}

TEST_F(RawlogMergeInstances, ARawlogWithInstancesIsNotMergedAgain)
{
	writeSidecar({1});
	ASSERT_EQ(run("in.rawlog out.rawlog").code, 0);
	const auto result = run("out.rawlog again.rawlog --instances in_instances.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_EQ(
		result.err,
		"rawlog-merge-instances: out.rawlog: has instances already; --split takes them out\n");
}

TEST_F(RawlogMergeInstances, ARawlogInPlaceOfTheSidecarIsRefused)
{
	const auto result = run("in.rawlog out.rawlog --instances in.rawlog");
	EXPECT_EQ(result.code, 2);
	fs::copy_file(folder_.path() / "in.rawlog", folder_.path() / "other.rawlog");
	const auto other = run("in.rawlog out.rawlog --instances other.rawlog");
	EXPECT_EQ(other.code, 1);
	EXPECT_THAT(other.err, HasSubstr("other.rawlog: holds a mrpt::obs::CObservationOdometry"));
}

TEST_F(RawlogMergeInstances, OfACutRawlogWhatIsThereIsMerged)
{
	writeSidecar({1, 2, 3, 4});
	// Stored plainly, so that the cut is inside the last scan.
	const std::string bytes = uncompressed(folder_.file("in.rawlog"));
	folder_.write("in.rawlog", bytes.substr(0, bytes.size() - 10));
	const auto result = run("in.rawlog out.rawlog");
	EXPECT_EQ(result.code, 1);
	EXPECT_THAT(result.err, HasSubstr("the file ends inside a mrpt::obs::CObservation3DRangeScan"));
	EXPECT_THAT(result.out, HasSubstr("7 objects and 3 observations of instances; 1 without"));
	EXPECT_EQ(contents("out.rawlog").size(), 11u);
}

}  // namespace
