#include "UnplugListener.h"

#include <OpenNI.h>
#include <mrpt/hwdrivers/COpenNI2Generic.h>

#include <utility>

namespace semloop
{
namespace
{
class OpenNi2Listener : public UnplugListener, openni::OpenNI::DeviceDisconnectedListener
{
public:
	explicit OpenNi2Listener(std::function<void()> onUnplugged)
		: onUnplugged_(std::move(onUnplugged))
	{
		openni::OpenNI::addDeviceDisconnectedListener(this);
	}
	~OpenNi2Listener() override { openni::OpenNI::removeDeviceDisconnectedListener(this); }

private:
	void onDeviceDisconnected(const openni::DeviceInfo*) override { onUnplugged_(); }

	std::function<void()> onUnplugged_;
};
}  // namespace

std::unique_ptr<UnplugListener> UnplugListener::listenFor(
	const mrpt::hwdrivers::CGenericSensor& sensor, std::function<void()> onUnplugged)
{
	const auto* openni = dynamic_cast<const mrpt::hwdrivers::COpenNI2Generic*>(&sensor);
	if (!openni || openni->getNumDevices() != 1) return nullptr;
	return std::make_unique<OpenNi2Listener>(std::move(onUnplugged));
}

}  // namespace semloop
