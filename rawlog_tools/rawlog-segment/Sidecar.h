#pragma once

#include <mrpt/core/Clock.h>
#include <semloop/observations/CObservationInstances.h>
#include <semloop/observations/RawlogWriter.h>

#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace semloop
{
/** What a sidecar holds. */
struct SidecarContents
{
	std::set<mrpt::Clock::time_point> times;  //!< of the frames in it
	std::map<std::string, std::size_t> instancesOfLabel;

	void add(const CObservationInstances& observation);
	std::size_t instanceCount() const;
};

/** The rawlog of instances beside a rawlog. Its first entry is a CObservationComment with the settings
 *  it was made with, as JSON; an interrupted one is continued when these are the same. */
class Sidecar
{
public:
	/** Takes over what an earlier run has left. Throws InputError, saying which setting differs, when
	 *  that was made with others, and when nothing can be written there.
	 *  @param force begin anew whatever is there */
	Sidecar(const std::string& path, const nlohmann::json& settings, bool force);

	/** An earlier run came to its end: there is nothing to do. */
	bool isComplete() const { return complete_; }
	const SidecarContents& contents() const { return contents_; }
	/** How many frames came from an earlier run. */
	std::size_t resumedFrames() const { return resumedFrames_; }

	void write(const CObservationInstances& observation);
	/** Gives the file its final name. */
	void close();

private:
	void beginAnew(bool force);
	void resume();

	std::string path_;
	nlohmann::json settings_;
	std::unique_ptr<RawlogWriter> writer_;
	bool headerWritten_ = false;
	bool complete_ = false;
	SidecarContents contents_;
	std::size_t resumedFrames_ = 0;
};

}  // namespace semloop
