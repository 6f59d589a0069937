#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <semloop/config/Options.h>
#include <semloop/observations/ObservationSource.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace semloop
{
struct SensorSourceOptions : Options
{
	int queueLength = 30;     //!< frames waiting; a hundred times as many others
	double stallAfter = 1.0;  //!< [s]
	double lostAfter = 10.0;  //!< [s]
	double startTime = 0.0;   //!< Unix time of the first observation [s]; 0: as the sensor says

	void requireConsistent() const override;

protected:
	void describe(OptionFields& fields) override;
};

/** What became of a sensor's observations so far, of RGB-D scans (frames) and of all others. */
struct SensorCounts
{
	std::size_t grabbed = 0;
	std::size_t dropped = 0;    //!< the queue was full: the next step had no time for them
	std::size_t stalls = 0;     //!< more than stall_after without a frame
	double longestStall = 0.0;  //!< [s]
};

/** Grabs from any sensor of MRPT or of a plug-in (mrpt::hwdrivers::CGenericSensor), in a thread of its
 *  own. A section of the configuration describes the sensor as rawlog-grabber wants it: `driver` is its
 *  class.
 *
 *  A sensor does not wait: when the queue is full, the oldest frame is dropped and counted, or the oldest
 *  of all others when there are a hundred times as many. Its silence is reported after stall_after and
 *  when it ends; after lost_after the sensor is given up. */
class SensorSource : public ObservationSource
{
public:
	using Tap = std::function<void(const mrpt::obs::CObservation::Ptr&)>;
	using Report = std::function<void(const std::string&)>;

	/** Starts to grab. The tap, if any, gets every observation as it comes, in the grabbing thread, also
	 *  those that are dropped; report gets news for a person, one line each, in the thread of next().
	 *
	 *  Throws UsageError when the section names no known class or the sensor refuses what is in it. */
	SensorSource(
		const mrpt::config::CConfigFileBase& config, const std::string& section,
		const SensorSourceOptions& options, Tap tap, Report report);
	/** Stops the sensor. One that does not come back from its driver is left behind, see isStuck(). */
	~SensorSource() override;

	/** Waits for an observation. Empty when a recording that is played as a sensor has ended and after
	 *  stop(); throws InputError when there is no device, the sensor failed or is silent for too long. */
	mrpt::obs::CObservation::Ptr next() override;
	const std::string& name() const override { return name_; }
	double progress() const override { return 0; }

	void stop() override;
	SensorCounts counts() const;
	/** After stop(), waits for at most so long; true when the driver has not returned by then. Such a
	 *  thread cannot be ended: the process must leave by std::_Exit(). */
	bool isStuck(std::chrono::milliseconds patience) const;

private:
	struct Channel;

	/** Reports a stall and its end; throws when the sensor is lost. */
	void watch();
	std::string whyLost() const;

	std::string name_;
	SensorSourceOptions options_;
	Report report_;
	std::shared_ptr<Channel> channel_;  //!< shared with the thread, which may outlive us
	bool silent_ = false, toldOfStart_ = false;
};

/** Sections of a configuration that describe a sensor: those with the key `driver`, those named after
 *  them, as X_LEFT and X_RIGHT with the calibration of X, and rawlog-grabber's [global]. */
std::vector<std::string> sensorSections(const mrpt::config::CConfigFileBase& config);

}  // namespace semloop
