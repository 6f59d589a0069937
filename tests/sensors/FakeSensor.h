#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <semloop/sensors/RecordedSensor.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace semloop
{
/** A sensor that does, turn by turn, what a test has written down for it. */
class FakeSensor : public mrpt::hwdrivers::CGenericSensor, public RecordedSensor
{
	DEFINE_GENERIC_SENSOR(FakeSensor)

public:
	enum class Turn
	{
		Frame,       //!< gives a scan
		EarlyFrame,  //!< of an hour before
		TimelessFrame,
		Odometry,  //!< gives something else
		Nothing,
		Silence,  //!< takes 0.5 s
		Throw,
		ThrowNumber,
		Error,  //!< state ssError
		Hang    //!< until released
	};
	static std::vector<Turn>& script()
	{
		static std::vector<Turn> turns;
		return turns;
	}
	static std::atomic<bool>& released()
	{
		static std::atomic<bool> value{false};
		return value;
	}

	void loadConfig_sensorSpecific(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override
	{
		if (config.read_string(section, "mode", "") == "bad")
			throw std::runtime_error("mode = bad: there is no such mode");
	}

	void initialize() override { std::this_thread::sleep_for(startup()); }
	static std::chrono::milliseconds& startup()
	{
		static std::chrono::milliseconds time{0};
		return time;
	}

	void doProcess() override
	{
		using namespace std::chrono_literals;
		switch (turns_.at(next_++))
		{
			case Turn::Frame:
				give<mrpt::obs::CObservation3DRangeScan>();
				break;
			case Turn::EarlyFrame:
				give<mrpt::obs::CObservation3DRangeScan>(time(next_ - 1) - 1h);
				break;
			case Turn::TimelessFrame:
				give<mrpt::obs::CObservation3DRangeScan>(INVALID_TIMESTAMP);
				break;
			case Turn::Odometry:
				give<mrpt::obs::CObservationOdometry>();
				break;
			case Turn::Nothing:
				break;
			case Turn::Silence:
				std::this_thread::sleep_for(500ms);
				break;
			case Turn::Throw:
				throw std::runtime_error("the cable is broken");
			case Turn::ThrowNumber:
				throw 42;
			case Turn::Error:
				m_state = ssError;
				break;
			case Turn::Hang:
				while (!released()) std::this_thread::sleep_for(5ms);
		}
	}

	bool isAtEnd() const override { return next_ == turns_.size(); }

	/** Of what the i-th turn gives. */
	static mrpt::Clock::time_point time(std::size_t i)
	{
		return mrpt::Clock::fromDouble(5000 + 0.1 * double(i));
	}

private:
	template <class Observation>
	void give()
	{
		give<Observation>(time(next_ - 1));
	}
	template <class Observation>
	void give(mrpt::Clock::time_point time)
	{
		const auto observation = Observation::Create();
		observation->timestamp = time;
		appendObservation(observation);
	}

	const std::vector<Turn> turns_ = script();
	std::size_t next_ = 0;
};

}  // namespace semloop
