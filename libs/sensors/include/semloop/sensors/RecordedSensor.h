#pragma once

namespace semloop
{
/** A sensor that plays a recording: whoever grabs from it can tell its end from a failure, which MRPT's
 *  CGenericSensor has no state for. */
class RecordedSensor
{
public:
	virtual ~RecordedSensor() = default;

	/** True once the last observation has been queued for getObservations(). Throws InputError instead
	 *  when it is the last one because the recording is cut or damaged there. */
	virtual bool isAtEnd() const = 0;
};

}  // namespace semloop
