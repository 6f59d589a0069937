#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/poses/CPose3D.h>
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
/** Plays an .oni, a recording of OpenNI2's, as if its camera were there, for rawlog-grabber (with
 *  `-p libsemloop-sensors.so`) and `semloop-slam --live`:
 *
 *      [camera]
 *      driver       = COniFileSensor
 *      sensorLabel  = RGBD
 *      process_rate = 100        ; how often it is asked [Hz]
 *      file         = room.oni
 *      speed        = 1          ; 1 as recorded, 2 twice as fast, 0 a frame each time it is asked
 *      start_time   = 1305031453 ; Unix time of the first frame [s]; the computer's unless given
 *      camera_file  = xtion.ini  ; intrinsics (mrpt::img::TCamera); from the field of view unless given
 *      pose_x       = 0          ; of the camera on the robot [m], as for COpenNI2Sensor
 *      pose_y       = 0
 *      pose_z       = 0
 *      pose_yaw     = 0          ; [deg]
 *      pose_pitch   = 0
 *      pose_roll    = 0
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

	/** Opens the recording; throws as OniRecording does, and when it holds no pair. */
	void initialize() override;
	/** Queues the frames that are due. */
	void doProcess() override;
	bool isAtEnd() const override;

protected:
	/** Throws UsageError, naming section and key. */
	void loadConfig_sensorSpecific(
		const mrpt::config::CConfigFileBase& config, const std::string& section) override;

private:
	using SteadyClock = std::chrono::steady_clock;

	bool isDue(const OniFrame& frame) const;
	void queueNext();
	void forgetWhatWasLetGo();
	void waitForTheLast();

	std::string file_;
	std::string cameraFile_;
	double speed_ = 1;
	std::optional<mrpt::Clock::time_point> startTime_;
	mrpt::poses::CPose3D sensorPose_;

	std::optional<OniRecording> recording_;
	mrpt::img::TCamera camera_;
	std::optional<OniFrame> next_;
	std::exception_ptr failure_;  //!< why there is no next one, unless it is the end
	std::chrono::microseconds firstTime_{0};
	mrpt::Clock::time_point lastTime_;
	SteadyClock::time_point playedSince_;

	std::deque<std::weak_ptr<mrpt::obs::CObservation>> kept_;  //!< frames that somebody still has
	SteadyClock::time_point lastLetGo_;
	std::optional<SteadyClock::time_point> atEndSince_, lastMark_;
};

}  // namespace semloop
