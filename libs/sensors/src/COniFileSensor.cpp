#include <mrpt/core/bits_math.h>
#include <mrpt/core/initializer.h>
#include <mrpt/obs/CObservationComment.h>
#include <semloop/config/Error.h>
#include <semloop/config/ReadText.h>
#include <semloop/observations/CameraFile.h>
#include <semloop/observations/UnixTime.h>
#include <semloop/sensors/COniFileSensor.h>

#include <algorithm>
#include <charconv>
#include <cmath>

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

[[noreturn]] void fail(
	const std::string& section, const std::string& key, const std::string& value,
	const std::string& allowed)
{
	// MRPT's exceptions take a bracket for the end of a message.
	throw UsageError(section + ": " + key + " = " + value + ": must be " + allowed);
}

double readNumber(
	const CConfigFileBase& config, const std::string& section, const std::string& key,
	double otherwise)
{
	const std::string text = readText(config, section, key);
	if (text.empty()) return otherwise;
	double value = 0;
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, value);
	if (error != std::errc() || end != last || !std::isfinite(value))
		fail(section, key, text, "a number");
	return value;
}

}  // namespace

void COniFileSensor::loadConfig_sensorSpecific(
	const CConfigFileBase& config, const std::string& section)
{
	file_ = readText(config, section, "file");
	if (file_.empty()) fail(section, "file", file_, "a recording of OpenNI2, *.oni");
	cameraFile_ = readText(config, section, "camera_file");

	const auto number = [&](const std::string& key, double otherwise)
	{ return readNumber(config, section, key, otherwise); };
	speed_ = number("speed", 1);
	if (!(speed_ >= 0 && speed_ <= 1000))
		fail(
			section, "speed", readText(config, section, "speed"),
			"between 0 (a frame each time it is asked) and 1000; 1 is as recorded");

	startTime_.reset();
	const std::string start = readText(config, section, "start_time");
	if (!start.empty()) startTime_ = parseUnixTime(start);
	if (!start.empty() && !startTime_) fail(section, "start_time", start, "a Unix time in seconds");

	sensorPose_ = mrpt::poses::CPose3D::FromXYZYawPitchRoll(
		number("pose_x", 0), number("pose_y", 0), number("pose_z", 0),
		mrpt::DEG2RAD(number("pose_yaw", 0)), mrpt::DEG2RAD(number("pose_pitch", 0)),
		mrpt::DEG2RAD(number("pose_roll", 0)));
}

void COniFileSensor::initialize()
{
	recording_.emplace(file_);
	next_ = recording_->next();
	if (!next_)
		throw InputError(
			file_ + ": no colour and depth image in it were taken together: record it again");
	camera_ = cameraFile_.empty() ? recording_->camera() : readCameraFile(cameraFile_);
	if (cv::Size(int(camera_.ncols), int(camera_.nrows)) != next_->color.size())
		throw InputError(
			cameraFile_ + ": is for images of " + std::to_string(camera_.ncols) + "x" +
			std::to_string(camera_.nrows) + " pixels, those of " + file_ + " have " +
			std::to_string(next_->color.cols) + "x" + std::to_string(next_->color.rows));
	firstTime_ = next_->time;
	if (!startTime_) startTime_ = mrpt::Clock::now();
	playedSince_ = SteadyClock::now();
	m_state = ssWorking;
}

bool COniFileSensor::isAtEnd() const
{
	if (!recording_ || next_) return false;
	if (failure_) std::rethrow_exception(failure_);
	return true;
}

bool COniFileSensor::isDue(const OniFrame& frame) const
{
	const std::chrono::duration<double> played = SteadyClock::now() - playedSince_;
	return std::chrono::duration<double>(frame.time - firstTime_) <= speed_ * played;
}

void COniFileSensor::doProcess()
{
	if (!recording_) throw InputError("COniFileSensor: plays only after initialize()");
	if (!next_)
		waitForTheLast();
	else if (speed_ == 0)
		queueNext();
	else
		while (next_ && isDue(*next_)) queueNext();
}

void COniFileSensor::queueNext()
{
	const auto scan = rangeScanFrom(*next_, recording_->depthUnit(), camera_);
	lastTime_ =
		*startTime_ + std::chrono::duration_cast<mrpt::Clock::duration>(next_->time - firstTime_);
	scan->timestamp = lastTime_;
	scan->sensorLabel = m_sensorLabel;
	scan->sensorPose = sensorPose_;
	appendObservation(scan);
	forgetWhatWasLetGo();
	kept_.push_back(scan);
	next_.reset();
	try
	{
		next_ = recording_->next();
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
		throw InputError(file_ + ": played to its end");
	}
	if (!lastMark_ || now - std::max(news, *lastMark_) > kMarkEvery)
	{
		auto mark = mrpt::obs::CObservationComment::Create();
		lastTime_ += 1s;
		mark->timestamp = lastTime_;
		mark->sensorLabel = m_sensorLabel;
		mark->text = "the end of " + file_;
		appendObservation(mark);
		lastMark_ = now;
	}
}

}  // namespace semloop
