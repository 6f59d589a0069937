#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/object_map/Object.h>

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace semloop
{
struct LocalMapOptions : Options
{
	double length = 2.0;           //!< path over which objects stay in the local map [m]
	double metresPerRadian = 0.5;  //!< a turn counts as this much path [m/rad]
	double pathBetweenLoops =
		1.0;              //!< before that the drift since the last loop is not known better [m]
	double growth = 2.0;  //!< of the length while it is not clear where the local map belongs [m]

protected:
	void describe(OptionFields& fields) override;
};

/** The objects seen over the last few metres of path, i.e. as far as odometry can be trusted, without
 *  those that a loop closure has just made one with objects of another time
 *  (Sec. III-B): what detections are associated with, and the query of the loop detection.
 *
 *  What has left the local map was built under another drift. When it comes into view again it is
 *  mapped anew, and the two become one by a loop closure, which measures the drift between them, or,
 *  when there was none, by standing in one place (CObjectMap::findDuplicates). */
class LocalMap
{
public:
	explicit LocalMap(LocalMapOptions options = {}) : options_(std::move(options)) {}

	/** The camera moved. */
	void advance(const mrpt::poses::CPose3D& T_previous_camera);
	/** The object was seen from the current camera. */
	void see(ObjectId id) { lastSeen_[id] = path_; }

	bool contains(ObjectId id) const;
	std::set<ObjectId> objects() const;

	/** absorbed is a part of kept from now on. */
	void merge(ObjectId kept, ObjectId absorbed);
	void remove(ObjectId id) { lastSeen_.erase(id); }
	void loopClosed() { pathAtLoop_ = path_; }
	/** yes: objects stay longer, by the path from the first yes on, at most `growth`. no: as long as ever. */
	void keepGrowing(bool yes);
	/** Far enough from the last loop closure to look for another one. */
	bool isLoopDue() const
	{
		return !pathAtLoop_ || path_ - *pathAtLoop_ >= options_.pathBetweenLoops;
	}

	/** The local map is of the frames from this one on; the first call of advance() was for frame 0. */
	std::size_t firstFrame() const;

	double path() const { return path_; }  //!< travelled so far [m]

private:
	/** Path over which objects stay now [m]. */
	double length() const;

	LocalMapOptions options_;
	double path_ = 0.0;
	std::optional<double> growingFrom_;  //!< path [m]
	std::vector<double> pathAtFrame_;    //!< [m]
	std::optional<double> pathAtLoop_;
	std::map<ObjectId, double> lastSeen_;  //!< object -> path when last seen [m]
};

}  // namespace semloop
