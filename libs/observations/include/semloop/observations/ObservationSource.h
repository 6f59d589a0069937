#pragma once

#include <mrpt/obs/CObservation.h>

#include <string>

namespace semloop
{
/** Observations one after the other: a rawlog (RawlogReader), a sensor (SensorSource). */
class ObservationSource
{
public:
	virtual ~ObservationSource() = default;

	/** The next observation, waiting for it when need be; empty at the end. Throws what ends the
	 *  source early; what came before stays good. */
	virtual mrpt::obs::CObservation::Ptr next() = 0;

	/** No more is wanted: next() gives what waits, then ends. From any thread. A recording has nothing
	 *  to interrupt. */
	virtual void stop() {}

	/** What messages call it: a file's path, a sensor's label. */
	virtual const std::string& name() const = 0;
	/** Share of the whole that was read, in [0, 1]; 0 when there is no end in sight. */
	virtual double progress() const = 0;
};

}  // namespace semloop
