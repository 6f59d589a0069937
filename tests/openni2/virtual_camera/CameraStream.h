#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>

#include "OniDriver.h"

namespace semloop::virtual_camera
{
constexpr int kFarthest = 10000;  // [mm]; recordings keep nothing beyond, nor this itself

class CameraStream : public oni::driver::StreamBase
{
public:
	CameraStream(const OniSensorInfo& sensor, cv::Vec2f fieldOfView);

	OniStatus start() override;
	void stop() override { running_ = false; }
	bool isRunning() const { return running_; }
	OniSensorType type() const { return sensor_.sensorType; }
	OniVideoMode mode() const;

	void send(const cv::Mat& image, int index, uint64_t microseconds);

	OniBool isPropertySupported(int id) override;
	OniStatus getProperty(int id, void* data, int* size) override;
	OniStatus setProperty(int id, const void* data, int size) override;
	/** A recording that plays back wants to know them all. */
	void notifyAllProperties() override;

private:
	int stride() const;
	/** One of the sensor's modes, while no images come. */
	OniStatus setMode(const void* data, int size);

	const OniSensorInfo& sensor_;  //!< the camera's
	const cv::Vec2f fieldOfView_;  //!< horizontal, vertical [rad]
	std::atomic<bool> running_{false};
	std::atomic<bool> mirrored_{false};
	mutable std::mutex mutex_;  //!< of the mode
	OniVideoMode mode_;
};

}  // namespace semloop::virtual_camera
