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
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

/** A driver of OpenNI2 whose camera sees the RGB-D frames of a rawlog: put it into a folder
 *  OpenNI2/Drivers beside libOpenNI2.so.0, under a name lib*.so.0. What it does is in the environment:
 *
 *  SEMLOOP_CAMERA_RAWLOG  the rawlog
 *  SEMLOOP_CAMERA_RATE    frames a second, 30 unless given
 *  SEMLOOP_CAMERA_DROP    n: every n-th frame is lost
 *  SEMLOOP_CAMERA_STALL   n:s: before frame n there is nothing for s seconds
 *  SEMLOOP_CAMERA_UNPLUG  n: after n frames the camera is gone; at the end of the rawlog it always is */
namespace
{
using namespace oni::driver;
using Clock = std::chrono::steady_clock;

std::string environment(const char* name)
{
	const char* const value = std::getenv(name);
	return value ? value : "";
}

double number(const char* name, double otherwise)
{
	const std::string text = environment(name);
	return text.empty() ? otherwise : std::stod(text);
}

struct Settings
{
	std::string rawlog = environment("SEMLOOP_CAMERA_RAWLOG");
	double rate = number("SEMLOOP_CAMERA_RATE", 30);
	int drop = int(number("SEMLOOP_CAMERA_DROP", 0));
	int unplug = int(number("SEMLOOP_CAMERA_UNPLUG", 0));
	int stallBefore = -1;
	double stallSeconds = 0;

	Settings()
	{
		std::sscanf(
			environment("SEMLOOP_CAMERA_STALL").c_str(), "%d:%lf", &stallBefore, &stallSeconds);
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

class CameraStream : public StreamBase
{
public:
	CameraStream(OniSensorType type, const OniVideoMode& mode, cv::Vec2f fieldOfView)
		: type_(type), mode_(mode), fieldOfView_(fieldOfView)
	{
	}

	OniStatus start() override
	{
		running_ = true;
		return ONI_STATUS_OK;
	}
	void stop() override { running_ = false; }
	bool isRunning() const { return running_; }
	OniSensorType type() const { return type_; }

	void send(const cv::Mat& image, int index, uint64_t microseconds)
	{
		const std::lock_guard lock(mutex_);
		if (!running_) return;
		// Room is for images of the mode.
		if (image.size() != cv::Size(mode_.resolutionX, mode_.resolutionY) ||
			int(image.elemSize()) != pixelSize())
			return;
		OniFrame* const frame = getServices().acquireFrame();
		if (!frame) return;
		const std::size_t bytes = image.total() * image.elemSize();
		frame->dataSize = int(bytes);
		std::memcpy(frame->data, image.data, bytes);
		frame->sensorType = type_;
		frame->timestamp = microseconds;
		frame->frameIndex = index;
		frame->width = image.cols;
		frame->height = image.rows;
		frame->videoMode = mode_;
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
				return give(mode_, data, size);
			case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
				return give(fieldOfView_[0], data, size);
			case ONI_STREAM_PROPERTY_VERTICAL_FOV:
				return give(fieldOfView_[1], data, size);
			case ONI_STREAM_PROPERTY_MIRRORING:
				return give(OniBool(FALSE), data, size);
			case ONI_STREAM_PROPERTY_MAX_VALUE:
				return give(10000, data, size);
			case ONI_STREAM_PROPERTY_MIN_VALUE:
				return give(0, data, size);
			case ONI_STREAM_PROPERTY_STRIDE:
				return give(mode_.resolutionX * pixelSize(), data, size);
			case ONI_STREAM_PROPERTY_CROPPING:
				return give(OniCropping{}, data, size);
			default:
				return ONI_STATUS_NOT_SUPPORTED;
		}
	}

	OniStatus setProperty(int id, const void* data, int size) override
	{
		if (id == ONI_STREAM_PROPERTY_VIDEO_MODE && size == int(sizeof(mode_)))
			std::memcpy(&mode_, data, sizeof(mode_));
		return isPropertySupported(id) ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
	}
	OniPixelFormat format() const { return mode_.pixelFormat; }

	/** A recording that plays back wants to know them all. */
	void notifyAllProperties() override
	{
		const auto tell = [&](int id, const auto& value)
		{ raisePropertyChanged(id, &value, sizeof(value)); };
		tell(ONI_STREAM_PROPERTY_VIDEO_MODE, mode_);
		tell(ONI_STREAM_PROPERTY_HORIZONTAL_FOV, fieldOfView_[0]);
		tell(ONI_STREAM_PROPERTY_VERTICAL_FOV, fieldOfView_[1]);
		tell(ONI_STREAM_PROPERTY_MIRRORING, OniBool(FALSE));
		tell(ONI_STREAM_PROPERTY_MAX_VALUE, int(10000));
		tell(ONI_STREAM_PROPERTY_MIN_VALUE, int(0));
		tell(ONI_STREAM_PROPERTY_STRIDE, int(mode_.resolutionX * pixelSize()));
		tell(ONI_STREAM_PROPERTY_CROPPING, OniCropping{});
	}

private:
	int pixelSize() const
	{
		if (mode_.pixelFormat == ONI_PIXEL_FORMAT_RGB888) return 3;
		return mode_.pixelFormat == ONI_PIXEL_FORMAT_GRAY8 ? 1 : 2;
	}

	const OniSensorType type_;
	OniVideoMode mode_;
	const cv::Vec2f fieldOfView_;  //!< horizontal, vertical [rad]
	std::atomic<bool> running_{false};
	std::mutex mutex_;
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
		if (thread_.joinable()) thread_.join();
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
				auto stream = std::make_unique<CameraStream>(
					type, *sensor.pSupportedVideoModes, fieldOfView_);
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
		try
		{
			if (!playAll()) return;
		}
		catch (const std::exception& e)
		{
			std::fprintf(stderr, "virtual camera: %s\n", e.what());
		}
		unplugged_();
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
			const bool lost = settings_.drop > 0 && index % settings_.drop == settings_.drop - 1;
			if (!lost) send(*next_, index, uint64_t(std::llround((time + late).count() * 1e6)));
			next_ = recording_.next();
		}
		return true;
	}

	void send(const semloop::RgbdFrame& frame, int index, uint64_t microseconds)
	{
		cv::Mat color, depth;
		cv::cvtColor(frame.color, color, cv::COLOR_BGR2RGB);
		frame.depth.convertTo(depth, CV_16U, 1000);
		const std::lock_guard lock(mutex_);
		for (const auto& stream : streams_)
		{
			if (stream->type() == ONI_SENSOR_COLOR) stream->send(color, index, microseconds);
			if (stream->type() == ONI_SENSOR_DEPTH) stream->send(depth, index, microseconds);
			if (stream->type() == ONI_SENSOR_IR)
				stream->send(infrared(color, stream->format()), index, microseconds);
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
		info_.usbVendorId = info_.usbProductId = 0;
	}

	OniStatus initialize(
		DeviceConnectedCallback connected, DeviceDisconnectedCallback disconnected,
		DeviceStateChangedCallback changed, void* cookie) override
	{
		DriverBase::initialize(connected, disconnected, changed, cookie);
		if (!settings_.rawlog.empty()) deviceConnected(&info_);
		return ONI_STATUS_OK;
	}

	DeviceBase* deviceOpen(const char*, const char*) override
	{
		try
		{
			return new Camera(
				settings_,
				[this]
				{
					deviceStateChanged(&info_, ONI_DEVICE_STATE_ERROR);
					deviceDisconnected(&info_);
				});
		}
		catch (const std::exception& e)
		{
			getServices().errorLoggerAppend("%s", e.what());
			return nullptr;
		}
	}

	void deviceClose(DeviceBase* device) override { delete device; }
	void shutdown() override {}

private:
	const Settings settings_;
	OniDeviceInfo info_{};
};
}  // namespace

ONI_EXPORT_DRIVER(VirtualCameraDriver)
