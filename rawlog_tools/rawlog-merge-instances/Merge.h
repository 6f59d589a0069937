#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace semloop
{
struct MergeFiles
{
	std::string rawlog;     //!< without instances
	std::string instances;  //!< the sidecar
	std::string merged;     //!< both
};

struct MergeReport
{
	std::size_t objects = 0;    //!< of the rawlog alone
	std::size_t instances = 0;  //!< observations that were put in or taken out
	std::size_t left = 0;       //!< observations of the sidecar without a scan of their time
	std::string damage;         //!< why the input could not be read to its end; empty: it could
};

/** Share of the input that has been read, in [0, 1]. */
using MergeProgress = std::function<void(std::size_t objects, double share)>;

/** Writes `merged`: every object of the rawlog as it is, byte by byte, and right behind the one with a
 *  range scan the instances of its time. What stands in the sidecar before the first instances, its
 *  header, comes right before them; a header in the rawlog, left from instances that were removed, is
 *  dropped.
 *
 *  Throws InputError when the rawlog has instances already, the sidecar holds anything else, or its
 *  instances have no scan of their time (with `leaveOut` these are left out and counted), or scans are not
 *  in order of time. A rawlog or sidecar that was cut is merged up to there. */
MergeReport mergeInstances(const MergeFiles& files, bool leaveOut, const MergeProgress& progress);

/** The way back: `rawlog` and `instances` become what they were, uncompressed byte for byte. Throws
 *  InputError when there are no instances to take out. */
MergeReport splitInstances(const MergeFiles& files, const MergeProgress& progress);

/** Throws InputError when `to` has a folder of images that are not those of `from`; a link may be replaced
 *  by `force`. */
void requireFreeImagesFolder(const std::string& from, const std::string& to, bool force);

/** Lets a rawlog of another name find the external images of `from`, if it has any: a relative link beside
 *  `to`. */
void linkExternalImages(const std::string& from, const std::string& to);

}  // namespace semloop
