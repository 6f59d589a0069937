#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/TMetricMapInitializer.h>
#include <semloop/slam/SemanticSlam.h>

#include <string>
#include <vector>

namespace semloop
{
/** Maps of other kinds that a run leaves beside its object map, defined as in every program of MRPT
 *  (mrpt::maps::TSetOfMetricMapInitializers) by [semloop_map] <map>_count = N and by
 *  [semloop_map_<map>_NN_creationOpts], [..._insertOpts] and so on.
 *
 *  They are made at the end, from the key frames at their optimised poses: a map gets the frame's
 *  points and instances, and if it takes no points, as an occupancy grid, a horizontal scan. */
class OtherMaps
{
public:
	/** Throws UsageError for maps of no registered class, and for keys and sections that MRPT would
	 *  pass over in silence. Plug-ins must have been loaded. */
	explicit OtherMaps(const mrpt::config::CConfigFileBase& config);

	bool empty() const { return names_.empty(); }
	/** "<map>_NN" of each, in the order of build(). */
	const std::vector<std::string>& names() const { return names_; }

	mrpt::maps::CMultiMetricMap::Ptr build(const SemanticSlam& slam) const;

private:
	mrpt::maps::TSetOfMetricMapInitializers definitions_;
	std::vector<std::string> names_;
};

/** Sections [semloop_map_...] of a configuration; OtherMaps checks them. */
std::vector<std::string> otherMapsSections(const mrpt::config::CConfigFileBase& config);

/** Writes folder/<map>_NN... as each map saves itself, each map whole as <map>_NN.metricmap
 *  (occupancy grids .gridmap, as pf-localization calls it), and all in folder/maps.3Dscene. A folder
 *  of an earlier run is removed, also when there are no maps now. Throws InputError naming the file that cannot be written. */
void writeOtherMaps(
	const std::string& folder, const std::vector<std::string>& names,
	const mrpt::maps::CMultiMetricMap& maps);

}  // namespace semloop
