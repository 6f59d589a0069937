#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RawlogWriter.h>

#include "MrptPrograms.h"
#include "TwoInstances.h"

namespace
{
using namespace semloop;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

/** Debian's rawlog-edit, unmodified, on four observations of instances and odometry between them. */
class RawlogEdit : public testing::Test
{
protected:
	void SetUp() override
	{
		const std::string whyNot = whyNotRunnable("rawlog-edit");
		if (!whyNot.empty()) GTEST_SKIP() << whyNot;
		RawlogWriter writer(folder_.file("in.rawlog"));
		for (int i = 0; i < 4; i++)
		{
			auto instances = twoInstances(1000 + i);
			instances.sensorPose = mrpt::poses::CPose3D(1, 0, 0.5, 0, 0, 0);
			if (i == 2) instances.instances.clear();
			mrpt::obs::CObservationOdometry odometry;
			odometry.timestamp = instances.timestamp;
			odometry.sensorLabel = "ODO";
			writer.write(odometry);
			writer.write(instances);
		}
		writer.close();
	}

	ShellResult edit(const std::string& arguments) const
	{
		return shell(
			"timeout 60 rawlog-edit -p '" SEMLOOP_BINARY_DIR
			"/lib/libsemloop-observations.so' -q -i in.rawlog " +
				arguments,
			folder_.path());
	}
	/** Times of the instances in a rawlog. */
	std::vector<double> timesOfInstances(const std::string& name) const
	{
		std::vector<double> times;
		RawlogReader reader(folder_.file(name));
		while (const auto observation = reader.next())
			if (std::dynamic_pointer_cast<CObservationInstances>(observation))
				times.push_back(mrpt::Clock::toDouble(observation->timestamp));
		return times;
	}

	std::vector<std::string> classesIn(const std::string& name) const
	{
		std::vector<std::string> classes;
		RawlogReader reader(folder_.file(name));
		while (const auto observation = reader.next())
			classes.push_back(observation->GetRuntimeClass()->className);
		return classes;
	}

	TemporaryFolder folder_;
};

TEST_F(RawlogEdit, ShowsInfo)
{
	const auto result = edit("--info");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(result.out, HasSubstr("All sensor labels                 : ODO, instances"));
	EXPECT_THAT(result.out, HasSubstr("instances /      4 /1.000 /3.000"));
}

TEST_F(RawlogEdit, WithoutThePlugInStopsReadingAndSaysNothingOnStdout)
{
	// Why doc/mrpt-programs.md warns. Should MRPT tell one day, the warning can go.
	const auto result = shell("timeout 60 rawlog-edit -q -i in.rawlog --info", folder_.path());
	EXPECT_EQ(result.code, 0);
	EXPECT_THAT(result.out, HasSubstr("Overall number of objects         : 1\n"));
	EXPECT_THAT(result.err, HasSubstr("'semloop::CObservationInstances' which is not registered"));
}

TEST_F(RawlogEdit, Describes)
{
	const auto result = edit("--describe");
	EXPECT_EQ(result.code, 0) << result.err;
	EXPECT_THAT(
		result.out, AllOf(
						HasSubstr("ClassName: semloop::CObservationInstances"),
						HasSubstr("0: potted plant 0.75, confidence 0.5, box 8x6 at (10, 20), 48 "
								  "pixels, embedding of 2, with depth")));
}

TEST_F(RawlogEdit, ListsTimesAndPoses)
{
	ASSERT_EQ(edit("--list-timestamps --text-file-output times.txt").code, 0);
	EXPECT_THAT(readBytes(folder_.file("times.txt")), HasSubstr("semloop::CObservationInstances"));
	ASSERT_EQ(edit("--list-poses --text-file-output poses.txt").code, 0);
	// The odometry has none of its own.
	EXPECT_THAT(readBytes(folder_.file("poses.txt")), HasSubstr("[1.000000 0.000000 0.500000"));
}

TEST_F(RawlogEdit, CutsByIndexAndByTime)
{
	ASSERT_EQ(edit("--cut --from-index 4 -o byindex.rawlog").code, 0);
	EXPECT_EQ(timesOfInstances("byindex.rawlog"), (std::vector<double>{1002, 1003}));
	ASSERT_EQ(edit("--cut --from-time 1000.5 --to-time 1002.5 -o bytime.rawlog").code, 0);
	EXPECT_EQ(timesOfInstances("bytime.rawlog"), (std::vector<double>{1001, 1002}));
}

TEST_F(RawlogEdit, KeepsAndRemovesByLabel)
{
	ASSERT_EQ(edit("--keep-label instances -o kept.rawlog").code, 0);
	EXPECT_EQ(timesOfInstances("kept.rawlog").size(), 4u);
	ASSERT_EQ(edit("--remove-label instances -o removed.rawlog").code, 0);
	EXPECT_EQ(timesOfInstances("removed.rawlog").size(), 0u);
	EXPECT_THAT(classesIn("removed.rawlog"), Each(HasSubstr("Odometry")));
	EXPECT_EQ(classesIn("removed.rawlog").size(), 4u);
}

TEST_F(RawlogEdit, ExportsATableOfInstances)
{
	ASSERT_EQ(edit("--export-txt").code, 0);
	const auto numbers =
		"1000.000000 0 potted_plant 0.75 0.5 10 20 8 6 48\n"
		"     1000.000000 1 mug 1 1 40 5 3 2 6\n"
		"     1001.000000 0 potted_plant";
	EXPECT_THAT(
		readBytes(folder_.file("in_instances.txt")),
		AllOf(
			HasSubstr("Time INSTANCE LABEL SCORE CONFIDENCE BOX_X BOX_Y BOX_WIDTH BOX_HEIGHT "
					  "AREA_PX\n"),
			HasSubstr(numbers), HasSubstr("1002.000000 -1 - 0 0 0 0 0 0 0\n")));
}

}  // namespace
