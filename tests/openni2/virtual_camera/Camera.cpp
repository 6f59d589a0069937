#include "Camera.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "Property.h"

namespace semloop::virtual_camera
{
namespace
{
/** Whether it is one of every n, if n > 0. */
bool isNth(int index, int n)
{
	return n > 0 && index % n == n - 1;
}

/** Not that anyone looks at it, but MRPT waits for it. */
cv::Mat infrared(const cv::Mat& color, OniPixelFormat format)
{
	cv::Mat gray;
	if (format == ONI_PIXEL_FORMAT_RGB888) return color;
	cv::cvtColor(color, gray, cv::COLOR_RGB2GRAY);
	if (format == ONI_PIXEL_FORMAT_GRAY16) gray.convertTo(gray, CV_16U, 4);
	return gray;
}
}  // namespace

Camera::Camera(const CameraSettings& settings, std::function<void()> unplugged)
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
		mode(ONI_PIXEL_FORMAT_GRAY16), mode(ONI_PIXEL_FORMAT_GRAY8), mode(ONI_PIXEL_FORMAT_RGB888)};
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

Camera::~Camera()
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

OniStatus Camera::getSensorInfoList(OniSensorInfo** sensors, int* count)
{
	*sensors = sensors_.data();
	*count = int(sensors_.size());
	return ONI_STATUS_OK;
}

oni::driver::StreamBase* Camera::createStream(OniSensorType type)
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

void Camera::destroyStream(oni::driver::StreamBase* stream)
{
	const std::lock_guard lock(mutex_);
	streams_.erase(
		std::remove_if(
			streams_.begin(), streams_.end(), [&](const auto& own) { return own.get() == stream; }),
		streams_.end());
}

OniStatus Camera::getProperty(int id, void* data, int* size)
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

OniStatus Camera::setProperty(int id, const void* data, int size)
{
	if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != int(sizeof(registration_)))
		return ONI_STATUS_NOT_SUPPORTED;
	std::memcpy(&registration_, data, sizeof(registration_));
	return ONI_STATUS_OK;
}

OniBool Camera::isPropertySupported(int id)
{
	return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER || id == ONI_DEVICE_PROPERTY_DRIVER_VERSION ||
				   id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION
			   ? TRUE
			   : FALSE;
}

bool Camera::waitUntil(Clock::time_point time)
{
	std::unique_lock lock(mutex_);
	return !changed_.wait_until(lock, time, [&] { return stopped_; });
}

bool Camera::isWatched()
{
	const std::lock_guard lock(mutex_);
	return std::count_if(
			   streams_.begin(), streams_.end(),
			   [](const auto& stream)
			   { return stream->isRunning() && stream->type() != ONI_SENSOR_IR; }) >= 2;
}

void Camera::play()
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

bool Camera::playAll()
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

void Camera::send(const RgbdFrame& frame, int index, uint64_t microseconds)
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

}  // namespace semloop::virtual_camera
