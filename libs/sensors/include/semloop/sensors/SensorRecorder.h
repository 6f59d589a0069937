#pragma once

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <string>

namespace semloop
{
/** Writes what a sensor gives to a rawlog, in a thread of its own: compressing takes longer than a
 *  camera waits. Keeps everything: write() waits when a second's worth of frames is queued. */
class SensorRecorder
{
public:
	/** Throws InputError when the file cannot be created. */
	explicit SensorRecorder(const std::string& path);
	/** Closes, unless that was done; an error is lost then. */
	~SensorRecorder();

	/** From any thread; after an error and after close() nothing more is written. */
	void write(const mrpt::obs::CObservation::Ptr& observation);
	/** Writes what is queued and gives the file its name. Throws InputError when something could not be
	 *  written; what could is in the partial file (RawlogWriter). */
	void close();

private:
	struct State;
	std::unique_ptr<State> state_;
};

}  // namespace semloop
