#include <gtest/gtest.h>
#include <mrpt/poses/Lie/SE.h>
#include <semloop/config/Error.h>
#include <semloop/observations/Trajectory.h>
#include <semloop/observations/UnixTime.h>

#include <random>

#include "TemporaryFolder.h"

using mrpt::poses::CPose3D;
using semloop::formatUnixTime;
using semloop::InputError;
using semloop::interpolate;
using semloop::parseUnixTime;
using semloop::readTumTrajectory;
using semloop::Trajectory;
using semloop::writeTumTrajectory;

namespace
{
mrpt::Clock::time_point at(double seconds)
{
	return mrpt::Clock::fromDouble(seconds);
}

Trajectory quarterTurn()
{
	return {
		{at(10), CPose3D::FromXYZYawPitchRoll(0, 0, 0, 0, 0, 0)},
		{at(12), CPose3D::FromXYZYawPitchRoll(2, 4, -6, M_PI / 2, 0, 0)}};
}

std::string errorOf(const std::string& path)
{
	return semloop::messageOf<InputError>([&] { readTumTrajectory(path); });
}

}  // namespace

TEST(UnixTime, KeepsEveryMicrosecond)
{
	for (const char* const text :
		 {"1305031453.374112", "1305031453.000001", "0.999999", "0.000000"})
		EXPECT_EQ(formatUnixTime(parseUnixTime(text).value()), text);
}

TEST(UnixTime, ReadsShortLongAndScientificForms)
{
	EXPECT_EQ(formatUnixTime(parseUnixTime("12").value()), "12.000000");
	EXPECT_EQ(formatUnixTime(parseUnixTime("12.5").value()), "12.500000");
	EXPECT_EQ(formatUnixTime(parseUnixTime("1.25e1").value()), "12.500000");
	EXPECT_EQ(formatUnixTime(parseUnixTime("12.1234567890123").value()), "12.123457");
	EXPECT_EQ(formatUnixTime(parseUnixTime("12.99999999999").value()), "13.000000");
}

TEST(UnixTime, AgreesWithMrptsClock)
{
	EXPECT_NEAR(
		mrpt::Clock::toDouble(parseUnixTime("1305031453.374112").value()), 1305031453.374112, 1e-6);
}

TEST(UnixTime, RefusesWhatIsNotATime)
{
	for (const char* const text :
		 {"", "abc", "12x", "12.5x", "-1", "nan", "inf", "1e300", ".", "1 2"})
		EXPECT_FALSE(parseUnixTime(text).has_value()) << text;
}

TEST(Trajectory, ComesBackFromAFileAsItWas)
{
	std::mt19937 random(1);
	std::uniform_real_distribution<double> metres(-5, 5), angle(-3, 3), pitch(-1.5, 1.5);
	Trajectory written;
	for (int i = 0; i < 50; i++)
		written.push_back(
			{at(1305031453.374112 + 0.033333 * i),
			 CPose3D::FromXYZYawPitchRoll(
				 metres(random), metres(random), metres(random), angle(random), pitch(random),
				 angle(random))});

	const semloop::TemporaryFolder folder;
	writeTumTrajectory(folder.file("t.tum"), written);
	const Trajectory read = readTumTrajectory(folder.file("t.tum"));
	ASSERT_EQ(read.size(), written.size());
	for (std::size_t i = 0; i < read.size(); i++)
	{
		EXPECT_EQ(formatUnixTime(read[i].time), formatUnixTime(written[i].time));
		// nine digits of a unit quaternion
		EXPECT_NEAR(mrpt::poses::Lie::SE<3>::log(read[i].pose - written[i].pose).norm(), 0, 1e-8);
	}
	writeTumTrajectory(folder.file("again.tum"), read);
	EXPECT_EQ(
		semloop::readBytes(folder.file("t.tum")), semloop::readBytes(folder.file("again.tum")));
}

TEST(Trajectory, ReadsTheBenchmarksOwnLines)
{
	const semloop::TemporaryFolder folder;
	const auto path = folder.write(
		"groundtruth.txt",
		"# ground truth trajectory\n"
		"# timestamp tx ty tz qx qy qz qw\n"
		"1305031449.7996 1.2334 -0.0113 1.6941 0 0 0.7071068 0.7071068\r\n"
		"\n"
		"1305031449.8096 1.2334 -0.0111 1.6939 0 0 -0.7071068 -0.7071068\n");
	const auto trajectory = readTumTrajectory(path);
	ASSERT_EQ(trajectory.size(), 2u);
	EXPECT_DOUBLE_EQ(trajectory[0].pose.x(), 1.2334);
	EXPECT_NEAR(trajectory[0].pose.yaw(), M_PI / 2, 1e-6);
	EXPECT_NEAR(trajectory[1].pose.yaw(), M_PI / 2, 1e-6);  // -q is the same rotation
	EXPECT_EQ(trajectory[1].time - trajectory[0].time, mrpt::Clock::duration(100'000));
}

TEST(Trajectory, NamesFileAndLineOfWhatItCannotRead)
{
	const semloop::TemporaryFolder folder;
	const std::string good = "1 0 0 0 0 0 0 1\n";
	for (const std::string bad :
		 {"2 0 0 0 0 0 1", "2 0 0 0 0 0 0 1 9", "x 0 0 0 0 0 0 1", "2 0 y 0 0 0 0 1",
		  "2 nan 0 0 0 0 0 1", "2 0 0 0 0 0 0 1.02", "2 0 0 0 0 0 0 0", "0.5 0 0 0 0 0 0 1"})
	{
		const auto path = folder.write("bad.tum", "# t\n" + good + bad + "\n");
		EXPECT_EQ(errorOf(path).find(path + ":3: "), 0u) << bad << " -> " << errorOf(path);
	}
	EXPECT_NE(errorOf(folder.file("missing.tum")).find("missing.tum"), std::string::npos);
}

TEST(Trajectory, AnEmptyFileIsAnEmptyTrajectory)
{
	const semloop::TemporaryFolder folder;
	EXPECT_TRUE(readTumTrajectory(folder.write("empty.tum", "")).empty());
	EXPECT_FALSE(interpolate({}, at(1), 1.0).has_value());
}

TEST(Trajectory, RefusesAPlaceThatCannotBeWritten)
{
	EXPECT_THROW(writeTumTrajectory("/nonexistent/t.tum", quarterTurn()), InputError);
}

TEST(Trajectory, InterpolatesPositionLinearlyAndRotationAtConstantRate)
{
	const auto pose = interpolate(quarterTurn(), at(10.5), 2.0).value();
	EXPECT_NEAR(pose.x(), 0.5, 1e-9);
	EXPECT_NEAR(pose.y(), 1.0, 1e-9);
	EXPECT_NEAR(pose.z(), -1.5, 1e-9);
	EXPECT_NEAR(pose.yaw(), M_PI / 8, 1e-9);
}

TEST(Trajectory, InterpolatesTheShortWayRoundHalfATurn)
{
	const Trajectory trajectory = {
		{at(0), CPose3D::FromYawPitchRoll(3.0, 0, 0)},
		{at(1), CPose3D::FromYawPitchRoll(-3.0, 0, 0)}};
	EXPECT_NEAR(std::abs(interpolate(trajectory, at(0.5), 2.0).value().yaw()), M_PI, 1e-9);
}

TEST(Trajectory, GivesTheSamplesThemselvesWhateverTheGap)
{
	const auto trajectory = quarterTurn();
	EXPECT_EQ(interpolate(trajectory, at(10), 0.0).value(), trajectory[0].pose);
	EXPECT_EQ(interpolate(trajectory, at(12), 0.0).value(), trajectory[1].pose);
}

TEST(Trajectory, HasNoPoseOutsideItsTimeOrInAGap)
{
	const auto trajectory = quarterTurn();
	EXPECT_FALSE(interpolate(trajectory, at(9.999), 5.0).has_value());
	EXPECT_FALSE(interpolate(trajectory, at(12.001), 5.0).has_value());
	EXPECT_FALSE(interpolate(trajectory, at(11), 1.9).has_value());
	EXPECT_TRUE(interpolate(trajectory, at(11), 2.0).has_value());
}

TEST(Trajectory, RepeatedTimesDoNotDivideByZero)
{
	Trajectory trajectory = quarterTurn();
	trajectory.insert(trajectory.begin(), trajectory.front());
	EXPECT_EQ(interpolate(trajectory, at(10), 5.0).value(), trajectory[0].pose);
	EXPECT_NEAR(interpolate(trajectory, at(11), 5.0).value().x(), 1.0, 1e-9);
}
