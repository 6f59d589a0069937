// The driver's header wants the name that compilers had before they knew of standards.
#ifndef linux
#define linux 1
#endif
#include <new>
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>
#include <semloop/observations/RawlogReader.h>
#include <semloop/observations/RgbdFrame.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

/** A driver of OpenNI2 whose camera sees the RGB-D frames of a rawlog: put it into a folder
 *  OpenNI2/Drivers beside libOpenNI2.so.0, under a name lib*.so.0. What it does is in the environment:
 *
 *  SEMLOOP_CAMERA_RAWLOG      the rawlog
 *  SEMLOOP_CAMERA_RATE        frames a second, 30 unless given
 *  SEMLOOP_CAMERA_DROP        n: every n-th frame is lost
 *  SEMLOOP_CAMERA_DROP_COLOR  n: of every n-th frame the colour image is lost
 *  SEMLOOP_CAMERA_STALL       n:s: before frame n (the first is 0) there is nothing for s seconds
 *  SEMLOOP_CAMERA_UNPLUG      n: after n frames the camera is gone; at the end of the rawlog it always is
 *
 *  A wrong value is told on stderr, and there is no camera. Like a real one it sees nothing beyond ten
 *  metres. It begins when both depth and colour are wanted.
 *
 *  Destroy the streams before OpenNI::shutdown(): the library destroys what is left with a lock held that
 *  every new frame needs too, and then waits for ever for whatever thread a driver has. */
namespace
{
using namespace oni::driver;
using Clock = std::chrono::steady_clock;

constexpr int kFarthest = 10000;  // [mm]; recordings keep nothing beyond, nor this itself

std::string environment(const std::string& name)
{
	const char* const value = std::getenv(name.c_str());
	return value ? value : "";
}

template <class Number>
std::optional<Number> parse(std::string_view text)
{
	Number value{};
	const char* const last = text.data() + text.size();
	const auto [end, error] = std::from_chars(text.data(), last, value);
	if (error != std::errc() || end != last) return std::nullopt;
	return value;
}

/** A variable of the environment, which must lie in [least, most]. */
template <class Number>
Number number(const std::string& name, Number otherwise, Number least, Number most)
{
	const std::string text = environment(name);
	if (text.empty()) return otherwise;
	const auto value = parse<Number>(text);
	if (!value || !(*value >= least && *value <= most))
		throw std::runtime_error(
			name + "=" + text + ": must be a number from " + std::to_string(least) + " to " +
			std::to_string(most));
	return *value;
}

int count(const std::string& name)
{
	return number(name, 0, 1, std::numeric_limits<int>::max());
}

/** Throws what is wrong with them, in a line. */
struct Settings
{
	std::string rawlog = environment("SEMLOOP_CAMERA_RAWLOG");
	double rate = number("SEMLOOP_CAMERA_RATE", 30.0, 0.1, 10000.0);
	int drop = count("SEMLOOP_CAMERA_DROP");  //!< 0: none, as below
	int dropColor = count("SEMLOOP_CAMERA_DROP_COLOR");
	int unplug = count("SEMLOOP_CAMERA_UNPLUG");
	int stallBefore = -1;
	double stallSeconds = 0;

	Settings()
	{
		const std::string name = "SEMLOOP_CAMERA_STALL", text = environment(name);
		if (text.empty()) return;
		const auto colon = text.find(':');
		const auto before = parse<int>(text.substr(0, colon));
		const auto seconds =
			colon < text.size() ? parse<double>(text.substr(colon + 1)) : std::nullopt;
		if (!before || *before < 0 || !seconds || !(*seconds >= 0 && *seconds < 1e6))
			throw std::runtime_error(name + "=" + text + ": must be FRAME:SECONDS");
		stallBefore = *before;
		stallSeconds = *seconds;
	}
};

/** The frames with colour and depth, one after the other. */
class Recording
{
public:
	explicit Recording(const std::string& rawlog) : reader_(rawlog) {}

	std::optional<semloop::RgbdFrame> next()
	{
		while (const auto observation = reader_.next())
		{
			const auto scan =
				std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(observation);
			if (scan) return semloop::rgbdFrameFrom(*scan);
		}
		return std::nullopt;
	}

private:
	semloop::RawlogReader reader_;
};

template <class Value>
OniStatus give(const Value& value, void* data, int* size)
{
	if (*size != int(sizeof(Value))) return ONI_STATUS_BAD_PARAMETER;
	std::memcpy(data, &value, sizeof(Value));
	return ONI_STATUS_OK;
}

bool isSame(const OniVideoMode& a, const OniVideoMode& b)
{
	return a.pixelFormat == b.pixelFormat && a.resolutionX == b.resolutionX &&
		   a.resolutionY == b.resolutionY && a.fps == b.fps;
}

class CameraStream : public StreamBase
{
public:
	CameraStream(const OniSensorInfo& sensor, cv::Vec2f fieldOfView)
		: sensor_(sensor), fieldOfView_(fieldOfView), mode_(sensor.pSupportedVideoModes[0])
	{
	}

	OniStatus start() override
	{
		running_ = true;
		return ONI_STATUS_OK;
	}
	void stop() override { running_ = false; }
	bool isRunning() const { return running_; }
	OniSensorType type() const { return sensor_.sensorType; }

	OniVideoMode mode() const
	{
		const std::lock_guard lock(mutex_);
		return mode_;
	}

	void send(const cv::Mat& image, int index, uint64_t microseconds)
	{
		const OniVideoMode mode = this->mode();
		// The library makes room for images of the mode.
		if (!running_ || image.size() != cv::Size(mode.resolutionX, mode.resolutionY) ||
			int(image.elemSize()) != pixelSize(mode))
			return;
		OniFrame* const frame = getServices().acquireFrame();
		if (!frame) return;
		const std::size_t bytes = image.total() * image.elemSize();
		cv::Mat sent(image.size(), image.type(), frame->data);
		if (mirrored_)
			cv::flip(image, sent, 1);
		else
			image.copyTo(sent);
		frame->dataSize = int(bytes);
		frame->sensorType = type();
		frame->timestamp = microseconds;
		frame->frameIndex = index;
		frame->width = image.cols;
		frame->height = image.rows;
		frame->videoMode = mode;
		frame->croppingEnabled = FALSE;
		frame->cropOriginX = frame->cropOriginY = 0;
		frame->stride = int(image.cols * int(image.elemSize()));
		raiseNewFrame(frame);
		getServices().releaseFrame(frame);
	}

	OniBool isPropertySupported(int id) override
	{
		for (const int known :
			 {ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
			  ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_MIRRORING,
			  ONI_STREAM_PROPERTY_MAX_VALUE, ONI_STREAM_PROPERTY_MIN_VALUE,
			  ONI_STREAM_PROPERTY_STRIDE, ONI_STREAM_PROPERTY_CROPPING})
			if (id == known) return TRUE;
		return FALSE;
	}

	OniStatus getProperty(int id, void* data, int* size) override
	{
		switch (id)
		{
			case ONI_STREAM_PROPERTY_VIDEO_MODE:
				return give(mode(), data, size);
			case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
				return give(fieldOfView_[0], data, size);
			case ONI_STREAM_PROPERTY_VERTICAL_FOV:
				return give(fieldOfView_[1], data, size);
			case ONI_STREAM_PROPERTY_MIRRORING:
				return give(OniBool(mirrored_), data, size);
			case ONI_STREAM_PROPERTY_MAX_VALUE:
				return give(kFarthest, data, size);
			case ONI_STREAM_PROPERTY_MIN_VALUE:
				return give(0, data, size);
			case ONI_STREAM_PROPERTY_STRIDE:
				return give(stride(), data, size);
			case ONI_STREAM_PROPERTY_CROPPING:
				return give(OniCropping{}, data, size);
			default:
				return ONI_STATUS_NOT_SUPPORTED;
		}
	}

	OniStatus setProperty(int id, const void* data, int size) override
	{
		if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) return setMode(data, size);
		if (id == ONI_STREAM_PROPERTY_MIRRORING && size == int(sizeof(OniBool)))
			mirrored_ = *static_cast<const OniBool*>(data) != FALSE;
		return isPropertySupported(id) ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
	}

	/** A recording that plays back wants to know them all. */
	void notifyAllProperties() override
	{
		const auto tell = [&](int id, const auto& value)
		{ raisePropertyChanged(id, &value, sizeof(value)); };
		tell(ONI_STREAM_PROPERTY_VIDEO_MODE, mode());
		tell(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, fieldOfView_[0]);
		tell(ONI_STREAM_PROPERTY_VERTICAL_FOV, fieldOfView_[1]);
		tell(ONI_STREAM_PROPERTY_MIRRORING, OniBool(mirrored_));
		tell(ONI_STREAM_PROPERTY_MAX_VALUE, kFarthest);
		tell(ONI_STREAM_PROPERTY_MIN_VALUE, int(0));
		tell(ONI_STREAM_PROPERTY_STRIDE, stride());
		tell(ONI_STREAM_PROPERTY_CROPPING, OniCropping{});
	}

private:
	static int pixelSize(const OniVideoMode& mode)
	{
		if (mode.pixelFormat == ONI_PIXEL_FORMAT_RGB888) return 3;
		return mode.pixelFormat == ONI_PIXEL_FORMAT_GRAY8 ? 1 : 2;
	}
	int stride() const { return mode().resolutionX * pixelSize(mode()); }

	/** One of the sensor's modes, while no images come. */
	OniStatus setMode(const void* data, int size)
	{
		OniVideoMode wanted;
		if (size != int(sizeof(wanted))) return ONI_STATUS_BAD_PARAMETER;
		std::memcpy(&wanted, data, sizeof(wanted));
		if (running_) return ONI_STATUS_OUT_OF_FLOW;
		const auto* const modes = sensor_.pSupportedVideoModes;
		if (std::none_of(
				modes, modes + sensor_.numSupportedVideoModes,
				[&](const OniVideoMode& mode) { return isSame(mode, wanted); }))
			return ONI_STATUS_NOT_SUPPORTED;
		const std::lock_guard lock(mutex_);
		mode_ = wanted;
		return ONI_STATUS_OK;
	}

	const OniSensorInfo& sensor_;  //!< the camera's
	const cv::Vec2f fieldOfView_;  //!< horizontal, vertical [rad]
	std::atomic<bool> running_{false};
	std::atomic<bool> mirrored_{false};
	mutable std::mutex mutex_;  //!< of the mode
	OniVideoMode mode_;
};

class Camera : public DeviceBase
{
public:
	Camera(const Settings& settings, std::function<void()> unplugged)
		: settings_(settings), recording_(settings.rawlog), unplugged_(std::move(unplugged))
	{
		next_ = recording_.next();
		if (!next_) throw std::runtime_error(settings.rawlog + ": no RGB-D frame in it");
		const cv::Size size = next_->color.size();
		constexpr int rate = 30;  // what programs ask for, whatever comes
		const auto mode = [&](OniPixelFormat format) {
			return OniVideoMode{format, size.width, size.height, rate};
		};
		colorMode_ = mode(ONI_PIXEL_FORMAT_RGB888);
		depthMode_ = mode(ONI_PIXEL_FORMAT_DEPTH_1_MM);
		infraredModes_ = {
			mode(ONI_PIXEL_FORMAT_GRAY16), mode(ONI_PIXEL_FORMAT_GRAY8),
			mode(ONI_PIXEL_FORMAT_RGB888)};
		// Without an infrared sensor in the format it asks for, MRPT starts no stream and says nothing.
		sensors_ = {
			OniSensorInfo{ONI_SENSOR_COLOR, 1, &colorMode_},
			OniSensorInfo{ONI_SENSOR_IR, int(infraredModes_.size()), infraredModes_.data()},
			OniSensorInfo{ONI_SENSOR_DEPTH, 1, &depthMode_}};
		const auto& camera = next_->camera;
		fieldOfView_ = {
			float(2 * std::atan(size.width / (2 * camera.fx()))),
			float(2 * std::atan(size.height / (2 * camera.fy())))};
		thread_ = std::thread([this] { play(); });
	}

	~Camera() override
	{
		{
			const std::lock_guard lock(mutex_);
			stopped_ = true;
		}
		changed_.notify_all();
		// Whoever is told that the camera is gone may close it there and then.
		if (thread_.get_id() == std::this_thread::get_id())
			thread_.detach();
		else
			thread_.join();
	}

	OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override
	{
		*sensors = sensors_.data();
		*count = int(sensors_.size());
		return ONI_STATUS_OK;
	}

	StreamBase* createStream(OniSensorType type) override
	{
		for (const auto& sensor : sensors_)
			if (sensor.sensorType == type)
			{
				auto stream = std::make_unique<CameraStream>(sensor, fieldOfView_);
				const std::lock_guard lock(mutex_);
				streams_.push_back(std::move(stream));
				return streams_.back().get();
			}
		return nullptr;
	}

	void destroyStream(StreamBase* stream) override
	{
		const std::lock_guard lock(mutex_);
		streams_.erase(
			std::remove_if(
				streams_.begin(), streams_.end(),
				[&](const auto& own) { return own.get() == stream; }),
			streams_.end());
	}

	OniStatus getProperty(int id, void* data, int* size) override
	{
		const std::string serial = "semloop-virtual";  // MRPT has room for 15 characters
		switch (id)
		{
			case ONI_DEVICE_PROPERTY_SERIAL_NUMBER:
				if (*size <= int(serial.size())) return ONI_STATUS_BAD_PARAMETER;
				std::memcpy(data, serial.c_str(), serial.size() + 1);
				*size = int(serial.size()) + 1;
				return ONI_STATUS_OK;
			case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
				return give(OniVersion{1, 0, 0, 0}, data, size);
			case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION:
				return give(registration_, data, size);
			default:
				return ONI_STATUS_NOT_SUPPORTED;
		}
	}

	OniStatus setProperty(int id, const void* data, int size) override
	{
		if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != int(sizeof(registration_)))
			return ONI_STATUS_NOT_SUPPORTED;
		std::memcpy(&registration_, data, sizeof(registration_));
		return ONI_STATUS_OK;
	}

	OniBool isPropertySupported(int id) override
	{
		return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
					   id == ONI_DEVICE_PROPERTY_DRIVER_VERSION ||
					   id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION
				   ? TRUE
				   : FALSE;
	}

	/** The recorded depth is the colour image's already. */
	OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

private:
	/** True when there is time to wait, false when the camera is to stop. */
	bool waitUntil(Clock::time_point time)
	{
		std::unique_lock lock(mutex_);
		return !changed_.wait_until(lock, time, [&] { return stopped_; });
	}

	/** Somebody wants depth and colour. */
	bool isWatched()
	{
		const std::lock_guard lock(mutex_);
		return std::count_if(
				   streams_.begin(), streams_.end(),
				   [](const auto& stream)
				   { return stream->isRunning() && stream->type() != ONI_SENSOR_IR; }) >= 2;
	}

	/** A rawlog that cannot be read further is a camera that is gone. */
	void play()
	{
		const auto unplugged = unplugged_;  // the call may be the end of this object
		try
		{
			if (!playAll()) return;
		}
		catch (const std::exception& e)
		{
			std::fprintf(stderr, "virtual camera: %s\n", e.what());
		}
		unplugged();
	}

	/** False when it was told to stop. */
	bool playAll()
	{
		while (!isWatched())
			if (!waitUntil(Clock::now() + std::chrono::milliseconds(5))) return false;
		// The library drops what comes before it has noted that a stream has started.
		if (!waitUntil(Clock::now() + std::chrono::milliseconds(50))) return false;
		const auto start = Clock::now();
		auto late = std::chrono::duration<double>(0);
		for (int index = 0; next_; ++index)
		{
			if (settings_.unplug > 0 && index == settings_.unplug) break;
			if (index == settings_.stallBefore)
				late += std::chrono::duration<double>(settings_.stallSeconds);
			const std::chrono::duration<double> time(index / settings_.rate);
			const auto due = start + std::chrono::duration_cast<Clock::duration>(time + late);
			if (!waitUntil(due)) return false;
			if (!isNth(index, settings_.drop))
				send(*next_, index, uint64_t(std::llround((time + late).count() * 1e6)));
			next_ = recording_.next();
		}
		return true;
	}

	/** Whether it is one of every n, if n > 0. */
	static bool isNth(int index, int n) { return n > 0 && index % n == n - 1; }

	void send(const semloop::RgbdFrame& frame, int index, uint64_t microseconds)
	{
		cv::Mat color, depth;
		cv::cvtColor(frame.color, color, cv::COLOR_BGR2RGB);
		frame.depth.convertTo(depth, CV_16U, 1000);
		depth.setTo(0, depth >= kFarthest);
		const std::lock_guard lock(mutex_);
		for (const auto& stream : streams_)
		{
			if (stream->type() == ONI_SENSOR_COLOR && !isNth(index, settings_.dropColor))
				stream->send(color, index, microseconds);
			if (stream->type() == ONI_SENSOR_DEPTH) stream->send(depth, index, microseconds);
			if (stream->type() == ONI_SENSOR_IR)
				stream->send(infrared(color, stream->mode().pixelFormat), index, microseconds);
		}
	}

	/** Not that anyone looks at it, but MRPT waits for it. */
	static cv::Mat infrared(const cv::Mat& color, OniPixelFormat format)
	{
		cv::Mat gray;
		if (format == ONI_PIXEL_FORMAT_RGB888) return color;
		cv::cvtColor(color, gray, cv::COLOR_RGB2GRAY);
		if (format == ONI_PIXEL_FORMAT_GRAY16) gray.convertTo(gray, CV_16U, 4);
		return gray;
	}

	const Settings settings_;
	Recording recording_;
	const std::function<void()> unplugged_;
	std::optional<semloop::RgbdFrame> next_;
	OniVideoMode colorMode_{}, depthMode_{};
	std::array<OniVideoMode, 3> infraredModes_;
	std::array<OniSensorInfo, 3> sensors_;
	cv::Vec2f fieldOfView_;
	OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
	std::vector<std::unique_ptr<CameraStream>> streams_;
	std::mutex mutex_;
	std::condition_variable changed_;
	bool stopped_ = false;
	std::thread thread_;
};

class VirtualCameraDriver : public DriverBase
{
public:
	explicit VirtualCameraDriver(OniDriverServices* services) : DriverBase(services)
	{
		std::snprintf(info_.uri, ONI_MAX_STR, "semloop://camera");
		std::snprintf(info_.vendor, ONI_MAX_STR, "semloop");
		std::snprintf(info_.name, ONI_MAX_STR, "virtual camera");
	}

	OniStatus initialize(
		DeviceConnectedCallback connected, DeviceDisconnectedCallback disconnected,
		DeviceStateChangedCallback changed, void* cookie) override
	{
		DriverBase::initialize(connected, disconnected, changed, cookie);
		try
		{
			settings_ = Settings();
			if (!settings_->rawlog.empty()) deviceConnected(&info_);
		}
		catch (const std::exception& e)
		{
			std::fprintf(stderr, "virtual camera: %s\n", e.what());
		}
		return ONI_STATUS_OK;
	}

	DeviceBase* deviceOpen(const char*, const char*) override
	{
		try
		{
			return new Camera(
				settings_.value(),
				[this]
				{
					deviceStateChanged(&info_, ONI_DEVICE_STATE_ERROR);
					deviceDisconnected(&info_);
				});
		}
		catch (const std::exception& e)
		{
			std::fprintf(stderr, "virtual camera: %s\n", e.what());
			return nullptr;
		}
	}

	void deviceClose(DeviceBase* device) override { delete device; }
	void shutdown() override {}

private:
	std::optional<Settings> settings_;
	OniDeviceInfo info_{};
};
}  // namespace

ONI_EXPORT_DRIVER(VirtualCameraDriver)
