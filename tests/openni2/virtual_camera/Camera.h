#pragma once

#include <semloop/observations/RgbdFrame.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "CameraSettings.h"
#include "CameraStream.h"
#include "OniDriver.h"
#include "Recording.h"

namespace semloop::virtual_camera
{
/** Plays a rawlog to its streams, in a thread of its own. */
class Camera : public oni::driver::DeviceBase
{
public:
	/** Throws when the rawlog has no frame. The thread calls unplugged() when it is at the end. */
	Camera(const CameraSettings& settings, std::function<void()> unplugged);
	~Camera() override;

	OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override;
	oni::driver::StreamBase* createStream(OniSensorType type) override;
	void destroyStream(oni::driver::StreamBase* stream) override;

	OniStatus getProperty(int id, void* data, int* size) override;
	OniStatus setProperty(int id, const void* data, int size) override;
	OniBool isPropertySupported(int id) override;
	/** The recorded depth is the colour image's already. */
	OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

private:
	using Clock = std::chrono::steady_clock;

	/** True when there is time to wait, false when the camera is to stop. */
	bool waitUntil(Clock::time_point time);
	/** Somebody wants depth and colour. */
	bool isWatched();
	/** A rawlog that cannot be read further is a camera that is gone. */
	void play();
	/** False when it was told to stop. */
	bool playAll();
	void send(const RgbdFrame& frame, int index, uint64_t microseconds);

	const CameraSettings settings_;
	Recording recording_;
	const std::function<void()> unplugged_;
	std::optional<RgbdFrame> next_;
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

}  // namespace semloop::virtual_camera
