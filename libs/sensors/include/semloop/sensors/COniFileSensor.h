#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/sensors/OniRecording.h>
#include <semloop/sensors/RecordedSensor.h>

#include <chrono>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>

namespace semloop
{
/** Keys are COpenNI2Sensor's where it has them. */
struct COniFileSensorOptions : Options
{
	std::string file;
	double speed = 1.0;
	std::string startTime;  //!< text: a double is not as exact as the clock
	std::string cameraFile;
	double x = 0.0, y = 0.0, z = 0.0;           //!< [m]
	double yaw = 0.0, pitch = 0.0, roll = 0.0;  //!< [deg]: without `_deg`, as MRPT's

	mrpt::poses::CPose3D pose() const;
	void requireConsistent() const override;

protected:
	void describe(OptionFields& fields) override;
};

/** Plays an .oni, a recording of OpenNI2's, as if its camera were there, for rawlog-grabber (with
 *  `-p libsemloop-sensors.so`) and `semloop-slam --live`:
 *
 *      [camera]
 *      driver       = COniFileSensor
 *      sensorLabel  = RGBD
 *      process_rate = 100        ; how often it is asked [Hz]
 *      file         = room.oni
 *
 *  doc/live.md has all keys.
 *
 *  It gives a CObservation3DRangeScan for each pair of colour and depth, images inside. Every frame comes,
 *  however seldom it is asked.
 *
 *  After the last frame doProcess() throws InputError, at the end of the recording as well: this is how
 *  rawlog-grabber ends by itself. It only writes half of what waits each time, and nothing more once a
 *  sensor has thrown; so the sensor waits until its last frame has been let go, and moves it on with a
 *  CObservationComment, which then stays unwritten. It waits in vain, for ten seconds, for whoever keeps
 *  that frame; who asks isAtEnd() does not. */
class COniFileSensor : public mrpt::hwdrivers::CGenericSensor, public RecordedSensor
{
	DEFINE_GENERIC_SENSOR(COniFileSensor)

public:
	COniFileSensor() = default;

	/** Opens the recording; throws as OniScans does. */
	void initialize() override;
	/** Queues the frames that are due. */
	void doProcess() override;
	bool isAtEnd() const override;

protected:
	/** Throws UsageError, naming section and key, or the camera's file. */
	void loadConfig_sensorSpecific(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

private:
	using SteadyClock = std::chrono::steady_clock;

	bool isDue(const mrpt::obs::CObservation& frame) const;
	void queueNext();
	void forgetWhatWasLetGo();
	void waitForTheLast();

	COniFileSensorOptions options_;
	std::optional<mrpt::img::TCamera> camera_;  //!< of the camera_file

	std::optional<OniScans> scans_;
	mrpt::obs::CObservation3DRangeScan::Ptr next_;
	std::exception_ptr failure_;  //!< why there is no next one, unless it is the end
	mrpt::Clock::time_point firstTime_, lastTime_;
	SteadyClock::time_point playedSince_;

	std::deque<std::weak_ptr<mrpt::obs::CObservation>> kept_;  //!< frames that somebody still has
	SteadyClock::time_point lastLetGo_;
	std::optional<SteadyClock::time_point> atEndSince_, lastMark_;
};

}  // namespace semloop
