#include <cstdio>
#include <optional>
#include <stdexcept>

#include "Camera.h"
#include "CameraSettings.h"
#include "OniDriver.h"

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
namespace semloop::virtual_camera
{
namespace
{
class VirtualCameraDriver : public oni::driver::DriverBase
{
public:
	explicit VirtualCameraDriver(OniDriverServices* services) : DriverBase(services)
	{
		std::snprintf(info_.uri, ONI_MAX_STR, "semloop://camera");
		std::snprintf(info_.vendor, ONI_MAX_STR, "semloop");
		std::snprintf(info_.name, ONI_MAX_STR, "virtual camera");
	}

	OniStatus initialize(
		oni::driver::DeviceConnectedCallback connected,
		oni::driver::DeviceDisconnectedCallback disconnected,
		oni::driver::DeviceStateChangedCallback changed, void* cookie) override
	{
		DriverBase::initialize(connected, disconnected, changed, cookie);
		try
		{
			settings_ = settingsFromEnvironment();
			if (!settings_->rawlog.empty()) deviceConnected(&info_);
		}
		catch (const std::exception& e)
		{
			std::fprintf(stderr, "virtual camera: %s\n", e.what());
		}
		return ONI_STATUS_OK;
	}

	oni::driver::DeviceBase* deviceOpen(const char*, const char*) override
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

	void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
	void shutdown() override {}

private:
	std::optional<CameraSettings> settings_;
	OniDeviceInfo info_{};
};
}  // namespace
}  // namespace semloop::virtual_camera

ONI_EXPORT_DRIVER(semloop::virtual_camera::VirtualCameraDriver)
