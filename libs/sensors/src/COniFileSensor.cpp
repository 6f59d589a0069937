#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/bits_math.h>
#include <mrpt/core/initializer.h>
#include <mrpt/obs/CObservationComment.h>
#include <semloop/config/Error.h>
#include <semloop/observations/CameraFile.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/sensors/COniFileSensor.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

IMPLEMENTS_GENERIC_SENSOR(COniFileSensor, semloop)

namespace semloop
{
MRPT_INITIALIZER(registerOniFileSensor)
{
	COniFileSensor::doRegister();
}

namespace
{
using mrpt::config::CConfigFileBase;
using namespace std::chrono_literals;

constexpr auto kMarkEvery = 3s;  // a grabber keeps what came last until more comes
constexpr auto kGiveUpAfter = 10s;

/** The section without the keys that MRPT itself reads from that of any sensor. */
mrpt::config::CConfigFileMemory ownKeys(const CConfigFileBase& config, const std::string& section)
{
	static const std::set<std::string> ofMrpt{
		"driver", "sensorLabel", "process_rate", "max_queue_len", "grab_decimation"};
	std::vector<std::string> keys;
	config.getAllKeys(section, keys);
	mrpt::config::CConfigFileMemory own;
	for (const auto& key : keys)
		if (ofMrpt.count(key) == 0) own.write(section, key, config.read_string(section, key, ""));
	return own;
}

}  // namespace

void COniFileSensorOptions::describe(OptionFields& f)
{
	f.text("file", file, "recording of OpenNI2 (.oni); must be given");
	f.number(
		"speed", speed, 0, 1000,
		"1: as recorded; 2: twice as fast; 0: a frame each time it is asked");
	f.text(
		"start_time", startTime, "Unix time of the first frame [s]; the computer's unless given");
	f.text(
		"camera_file", cameraFile,
		"intrinsics as `mrpt::img::TCamera` writes them; from the recorded field of view unless "
		"given");
	f.number("pose_x", x, -1000, 1000, "of the camera on the robot, forward [m]");
	f.number("pose_y", y, -1000, 1000, "left [m]");
	f.number("pose_z", z, -1000, 1000, "up [m]");
	f.number("pose_yaw", yaw, -360, 360, "[deg]");
	f.number("pose_pitch", pitch, -360, 360, "[deg]");
	f.number("pose_roll", roll, -360, 360, "[deg]");
}

void COniFileSensorOptions::requireConsistent() const
{
	if (file.empty()) throw UsageError("file: missing; name a recording of OpenNI2, *.oni");
	if (!startTime.empty() && !parseUnixTime(startTime))
		throw UsageError("start_time = " + startTime + ": must be a Unix time in seconds");
}

mrpt::poses::CPose3D COniFileSensorOptions::pose() const
{
	using mrpt::DEG2RAD;
	return mrpt::poses::CPose3D::FromXYZYawPitchRoll(
		x, y, z, DEG2RAD(yaw), DEG2RAD(pitch), DEG2RAD(roll));
}

void COniFileSensor::loadConfig_sensorSpecific(
	const CConfigFileBase& config, const std::string& section)
{
	options_ = {};
	options_.loadFromConfigFile(ownKeys(config, section), section);
	camera_.reset();
	if (options_.cameraFile.empty()) return;
	try
	{
		camera_ = readCameraFile(options_.cameraFile);
	}
	catch (const UsageError& e)
	{
		// MRPT takes what comes before the first bracket for the place, and the rest for the message.
		throw UsageError("configuration: [" + section + "] camera_file: " + e.what());
	}
}

void COniFileSensor::initialize()
{
	OniRecording recording(options_.file);
	const auto start = parseUnixTime(options_.startTime).value_or(mrpt::Clock::now());
	scans_.emplace(std::move(recording), camera_, start);
	next_ = scans_->next();
	firstTime_ = next_->timestamp;
	playedSince_ = SteadyClock::now();
	m_state = ssWorking;
}

bool COniFileSensor::isAtEnd() const
{
	if (!scans_ || next_) return false;
	if (failure_) std::rethrow_exception(failure_);
	return true;
}

bool COniFileSensor::isDue(const mrpt::obs::CObservation& frame) const
{
	const std::chrono::duration<double> played = SteadyClock::now() - playedSince_;
	return std::chrono::duration<double>(frame.timestamp - firstTime_) <= options_.speed * played;
}

void COniFileSensor::doProcess()
{
	if (!scans_) throw InputError("COniFileSensor: plays only after initialize()");
	if (!next_)
		waitForTheLast();
	else if (options_.speed == 0)
		queueNext();
	else
		while (next_ && isDue(*next_)) queueNext();
}

void COniFileSensor::queueNext()
{
	lastTime_ = next_->timestamp;
	next_->sensorLabel = m_sensorLabel;
	next_->sensorPose = options_.pose();
	appendObservation(next_);
	forgetWhatWasLetGo();
	kept_.push_back(next_);
	next_.reset();
	try
	{
		next_ = scans_->next();
	}
	catch (const InputError&)
	{
		failure_ = std::current_exception();  // to be thrown when the frames before are safe
	}
}

void COniFileSensor::forgetWhatWasLetGo()
{
	for (; !kept_.empty() && kept_.front().expired(); kept_.pop_front())
		lastLetGo_ = SteadyClock::now();
}

void COniFileSensor::waitForTheLast()
{
	forgetWhatWasLetGo();
	const auto now = SteadyClock::now();
	if (!atEndSince_) atEndSince_ = now;
	const auto news = std::max(lastLetGo_, *atEndSince_);
	if (kept_.empty() || now - news > kGiveUpAfter)
	{
		if (failure_) std::rethrow_exception(failure_);
		throw InputError(options_.file + ": played to its end");
	}
	if (!lastMark_ || now - std::max(news, *lastMark_) > kMarkEvery)
	{
		auto mark = mrpt::obs::CObservationComment::Create();
		lastTime_ += 1s;
		mark->timestamp = lastTime_;
		mark->sensorLabel = m_sensorLabel;
		mark->text = "the end of " + options_.file;
		appendObservation(mark);
		lastMark_ = now;
	}
}

}  // namespace semloop
