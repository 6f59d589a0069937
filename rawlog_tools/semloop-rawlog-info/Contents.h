#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** The observations of one class and sensor label. */
struct Stream
{
	std::size_t observations = 0;
	std::vector<mrpt::Clock::time_point> times;  //!< in the file's order, of those that have one
	std::map<std::string, std::size_t> forms;    //!< what its images are like, and how many
	std::map<std::string, std::size_t> instancesOfLabel;

	struct Gap
	{
		mrpt::Clock::time_point begin;
		double seconds = 0;
	};
	/** Longer than 2.5 times the usual time between two observations (the larger of median and mean),
	 *  in the order of time. */
	std::vector<Gap> gaps() const;
	/** Observations that are earlier than the one before them. */
	std::size_t outOfOrder() const;
};

/** What a rawlog holds. */
class Contents
{
public:
	/** Key: sensor label, class. */
	const std::map<std::pair<std::string, std::string>, Stream>& streams() const
	{
		return streams_;
	}
	std::size_t observations() const { return observations_; }
	/** Files that the rawlog names and that are not there. */
	const std::vector<std::string>& missingFiles() const { return missing_; }
	/** Number of the first observation that MRPT's programs cannot read without a plug-in. */
	const std::optional<std::size_t>& firstInstances() const { return firstInstances_; }

	/** Times of an observation without any (MRPT's INVALID_TIMESTAMP) do not count. */
	void add(const mrpt::obs::CObservation& observation);
	/** Reads the images of the last one as semloop does; throws InputError when they are damaged. */
	static void checkImages(const mrpt::obs::CObservation& observation);

private:
	std::map<std::pair<std::string, std::string>, Stream> streams_;
	std::size_t observations_ = 0;
	std::vector<std::string> missing_;
	std::optional<std::size_t> firstInstances_;
};

}  // namespace semloop
