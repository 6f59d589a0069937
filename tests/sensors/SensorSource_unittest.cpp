#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <semloop/config/Error.h>
#include <semloop/sensors/SensorSource.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "FakeSensor.h"

using namespace semloop;
using namespace std::chrono_literals;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using Turn = FakeSensor::Turn;

IMPLEMENTS_GENERIC_SENSOR(FakeSensor, semloop)

namespace
{
class SensorSourceTest : public testing::Test
{
protected:
	SensorSourceTest()
	{
		FakeSensor::doRegister();
		FakeSensor::released() = false;
		FakeSensor::startup() = 0ms;
		config_.write("camera", "driver", std::string("FakeSensor"));
	}

	SensorSource& grab(std::vector<Turn> script)
	{
		FakeSensor::script() = std::move(script);
		source_ = std::make_unique<SensorSource>(
			config_, "camera", options_,
			[this](const mrpt::obs::CObservation::Ptr& o) { tapped_.push_back(o->timestamp); },
			[this](const std::string& line) { reports_.push_back(line); });
		return *source_;
	}
	std::vector<mrpt::Clock::time_point> readAll(SensorSource& source)
	{
		std::vector<mrpt::Clock::time_point> times;
		try
		{
			while (const auto observation = source.next()) times.push_back(observation->timestamp);
		}
		catch (const InputError& e)
		{
			error_ = e.what();
		}
		return times;
	}
	std::string refusal(const std::string& section)
	{
		try
		{
			SensorSource(config_, section, options_, {}, {});
		}
		catch (const UsageError& e)
		{
			return e.what();
		}
		return "";
	}

	mrpt::config::CConfigFileMemory config_;
	SensorSourceOptions options_;
	std::unique_ptr<SensorSource> source_;
	std::vector<mrpt::Clock::time_point> tapped_;
	std::vector<std::string> reports_;
	std::string error_;
};
constexpr auto at = &FakeSensor::time;
}  // namespace

TEST_F(SensorSourceTest, GivesEverythingInOrderAndEndsWithTheRecording)
{
	auto& source = grab({Turn::Frame, Turn::Odometry, Turn::Nothing, Turn::Frame});
	EXPECT_THAT(readAll(source), ElementsAre(at(0), at(1), at(3)));
	EXPECT_EQ(error_, "");
	EXPECT_EQ(source.name(), "[camera] FakeSensor");
	EXPECT_EQ(source.counts().grabbed, 3u);
	EXPECT_EQ(source.counts().dropped, 0u);
	EXPECT_THAT(reports_, IsEmpty());
}

TEST_F(SensorSourceTest, DropsTheOldestFramesWhenTheQueueIsFullAndTapsThemNevertheless)
{
	options_.queueLength = 2;
	auto& source = grab({Turn::Frame, Turn::Odometry, Turn::Frame, Turn::Frame, Turn::Frame});
	ASSERT_FALSE(source.isStuck(10s));
	EXPECT_THAT(readAll(source), ElementsAre(at(1), at(3), at(4)));
	EXPECT_EQ(source.counts().grabbed, 5u);
	EXPECT_EQ(source.counts().dropped, 2u);
	EXPECT_EQ(tapped_.size(), 5u);
}

TEST_F(SensorSourceTest, DropsTheOldestOthersWhenThereAreAHundredTimesAsMany)
{
	options_.queueLength = 1;
	std::vector<Turn> script(103, Turn::Odometry);
	script[0] = Turn::Frame;
	auto& source = grab(script);
	ASSERT_FALSE(source.isStuck(10s));
	const auto times = readAll(source);
	ASSERT_EQ(times.size(), 101u);
	EXPECT_EQ(times[0], at(0));
	EXPECT_EQ(times[1], at(3));
	EXPECT_EQ(source.counts().dropped, 2u);
}

TEST_F(SensorSourceTest, TellsOfAStallOnceAndGoesOn)
{
	options_.stallAfter = 0.2;
	auto& source = grab({Turn::Frame, Turn::Silence, Turn::Frame});
	EXPECT_THAT(readAll(source), ElementsAre(at(0), at(2)));
	ASSERT_EQ(reports_.size(), 2u);
	EXPECT_THAT(reports_[0], HasSubstr("[camera] FakeSensor: no frame for 0."));
	EXPECT_THAT(reports_[1], HasSubstr("frames again"));
	EXPECT_EQ(source.counts().stalls, 1u);
	EXPECT_GE(source.counts().longestStall, 0.2);
	EXPECT_EQ(error_, "");
}

TEST_F(SensorSourceTest, GivesUpASilentSensorAndLeavesItsDriverBehind)
{
	options_.stallAfter = 0.1;
	options_.lostAfter = 0.4;
	auto& source = grab({Turn::Frame, Turn::Hang});
	EXPECT_THAT(readAll(source), ElementsAre(at(0)));
	EXPECT_THAT(error_, AllOf(HasSubstr("was it unplugged?"), HasSubstr("lost_after")));
	EXPECT_TRUE(source.isStuck(50ms));
	source_.reset();
	FakeSensor::released() = true;
}

TEST_F(SensorSourceTest, WhatTheSensorThrowsComesBehindWhatItGave)
{
	auto& source = grab({Turn::Frame, Turn::Frame, Turn::Throw});
	EXPECT_THAT(readAll(source), ElementsAre(at(0), at(1)));
	EXPECT_EQ(error_, "[camera] FakeSensor: the cable is broken");
}

TEST_F(SensorSourceTest, ASensorInStateOfErrorEndsTheSource)
{
	auto& source = grab({Turn::Frame, Turn::Error, Turn::Frame});
	EXPECT_THAT(readAll(source), ElementsAre(at(0)));
	EXPECT_THAT(error_, HasSubstr("reports an error"));
}

TEST_F(SensorSourceTest, StopGivesWhatWaitsAndEnds)
{
	auto& source = grab({Turn::Frame, Turn::Frame, Turn::Hang});
	while (source.counts().grabbed < 2) std::this_thread::sleep_for(1ms);
	source.stop();
	EXPECT_THAT(readAll(source), ElementsAre(at(0), at(1)));
	EXPECT_EQ(error_, "");
	FakeSensor::released() = true;
}

TEST_F(SensorSourceTest, AClockThatIsSetBackChangesNoOrder)
{
	auto& source =
		grab({Turn::Frame, Turn::Frame, Turn::EarlyFrame, Turn::EarlyFrame, Turn::EarlyFrame});
	const auto times = readAll(source);
	ASSERT_EQ(times.size(), 5u);
	EXPECT_EQ(times[1], at(1));
	// The first one behind comes as much later as it came, by any clock.
	EXPECT_GT(times[2], at(1));
	EXPECT_LT(times[2], at(1) + 10s);
	EXPECT_EQ(times[3] - times[2], at(3) - at(2));
	EXPECT_EQ(times[4] - times[3], at(4) - at(3));
	EXPECT_EQ(tapped_[4], times[4]) << "the recording has the same times";
	ASSERT_EQ(reports_.size(), 1u);
	EXPECT_THAT(reports_[0], HasSubstr("the clock was set back"));
}

TEST_F(SensorSourceTest, AFrameWithoutTimeIsOfNow)
{
	const auto before = mrpt::Clock::now();
	const auto times = readAll(grab({Turn::TimelessFrame}));
	ASSERT_EQ(times.size(), 1u);
	EXPECT_GE(times[0], before);
	EXPECT_LE(times[0], mrpt::Clock::now());
}

TEST_F(SensorSourceTest, OtherObservationsAreNoFrames)
{
	options_.stallAfter = 0.1;
	options_.lostAfter = 0.8;
	auto& source = grab({Turn::Frame, Turn::Odometry, Turn::Silence, Turn::Odometry, Turn::Hang});
	EXPECT_THAT(readAll(source), ElementsAre(at(0), at(1), at(3)));
	EXPECT_THAT(error_, AllOf(HasSubstr("no frame for 0."), HasSubstr("CObservationOdometry")));
	EXPECT_EQ(source.counts().stalls, 1u);
	FakeSensor::released() = true;
}

TEST_F(SensorSourceTest, MayTakeItsTimeToStart)
{
	FakeSensor::startup() = 700ms;
	options_.stallAfter = 0.1;
	options_.lostAfter = 0.3;
	auto& source = grab({Turn::Frame});
	EXPECT_THAT(readAll(source), ElementsAre(at(0)));
	EXPECT_EQ(error_, "");
	EXPECT_THAT(reports_, ElementsAre("[camera] FakeSensor: still starting; Ctrl-C ends it"));
	EXPECT_EQ(source.counts().stalls, 0u);
}

TEST_F(SensorSourceTest, AnythingThatADriverThrowsIsAnError)
{
	EXPECT_THAT(readAll(grab({Turn::Frame, Turn::ThrowNumber})), ElementsAre(at(0)));
	EXPECT_THAT(error_, HasSubstr("[camera] FakeSensor: its driver failed"));
}

TEST_F(SensorSourceTest, MovesTheTimesToTheStartTime)
{
	options_.startTime = 7000;
	auto& source = grab({Turn::Nothing, Turn::Frame, Turn::Frame});
	EXPECT_THAT(
		readAll(source),
		ElementsAre(
			mrpt::Clock::fromDouble(7000), mrpt::Clock::fromDouble(7000) + (at(2) - at(1))));
}

TEST_F(SensorSourceTest, WrongSectionsAreToldWithTheRemedy)
{
	EXPECT_THAT(refusal("nothing"), HasSubstr("[nothing]: no such section"));
	config_.write("empty", "label", std::string("x"));
	EXPECT_THAT(refusal("empty"), HasSubstr("[empty] driver: missing"));
	config_.write("camera", "driver", std::string("CNoSuchSensor"));
	EXPECT_THAT(refusal("camera"), AllOf(HasSubstr("CNoSuchSensor"), HasSubstr("plugins")));
	config_.write("camera", "driver", std::string("FakeSensor"));
	config_.write("camera", "mode", std::string("bad"));
	EXPECT_THAT(refusal("camera"), HasSubstr("[camera]: FakeSensor: mode = bad: there is no such"));
	config_.write("camera_LEFT", "fx", 525.0);
	config_.write("global", "rawlog_prefix", std::string("x"));
	EXPECT_THAT(sensorSections(config_), UnorderedElementsAre("camera", "camera_LEFT", "global"));
	EXPECT_THAT(sensorSections(mrpt::config::CConfigFileMemory("[global]\nx=1\n")), IsEmpty());
}

TEST(SensorSourceOptions, LostComesAfterStalled)
{
	mrpt::config::CConfigFileMemory config;
	config.write("live", "stall_after", 5.0);
	config.write("live", "lost_after", 2.0);
	SensorSourceOptions options;
	EXPECT_THROW(options.loadFromConfigFile(config, "live"), UsageError);
}
