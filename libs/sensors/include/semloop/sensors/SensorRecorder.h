#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace semloop
{
/** Writes what a sensor gives to a rawlog, in a thread of its own. The sensor does not wait for it: when
 *  the disk does not keep up, compression is left off first, and then what finds no room in the queue
 *  (a hundred frames, ten thousand others) is not recorded, and counted. */
class SensorRecorder
{
public:
	using Report = std::function<void(const std::string&)>;

	struct Counts
	{
		std::size_t recorded = 0;
		std::size_t omitted = 0;  //!< for lack of time, or of space
	};

	/** The report gets news for a person, one line each, from any thread. Throws InputError when the file
	 *  cannot be created. */
	SensorRecorder(const std::string& path, Report report);
	/** Without close() what was written stays in the partial file (RawlogWriter). A file to which nothing
	 *  was written is removed. */
	~SensorRecorder();

	/** From any thread; after an error and after close() nothing more is written. */
	void write(const mrpt::obs::CObservation::Ptr& observation);
	/** Writes what is queued and gives the file its name. Throws InputError when something could not be
	 *  written; what could is in the partial file. */
	void close();

	Counts counts() const;

private:
	struct State;

	void endThread();

	std::unique_ptr<State> state_;
};

}  // namespace semloop
