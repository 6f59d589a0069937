#pragma once

#include <mrpt/hwdrivers/CGenericSensor.h>

#include <functional>
#include <memory>

namespace semloop
{
/** Tells, from a thread of OpenNI2's, when the camera of a COpenNI2Sensor is unplugged: the sensor itself
 *  then waits for ever. */
class UnplugListener
{
public:
	/** Null for any other sensor, and when there are several cameras: which one is the sensor's MRPT does
	 *  not tell. The sensor must be initialized. */
	static std::unique_ptr<UnplugListener> listenFor(
		const mrpt::hwdrivers::CGenericSensor& sensor, std::function<void()> onUnplugged);
	virtual ~UnplugListener() = default;
};

}  // namespace semloop
