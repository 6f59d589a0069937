#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/object_map/Object.h>

#include <map>
#include <set>

namespace semloop
{
struct LocalMapOptions : Options
{
	double length = 2.0;           //!< path over which objects stay in the local map [m]
	double metresPerRadian = 0.5;  //!< a turn counts as this much path [m/rad]

protected:
	void describe(OptionFields& fields) override;
};

/** The objects seen over the last few metres of path, i.e. as far as odometry can be trusted
 *  (Sec. III-B): the query of the loop detection.
 *
 *  An object that comes back into view after it had left the local map is *revisited*: it was built
 *  at another time, under another drift, so it neither constrains the current cameras nor describes
 *  the place as seen now, until a loop closure has tied the two times together. */
class LocalMap
{
public:
	explicit LocalMap(LocalMapOptions options = {}) : options_(std::move(options)) {}

	/** The camera moved. */
	void advance(const mrpt::poses::CPose3D& T_previous_camera);
	/** The object was seen (isNew: created) from the current camera. */
	void see(ObjectId id, bool isNew);

	bool contains(ObjectId id) const;
	bool isRevisited(ObjectId id) const { return revisited_.count(id) > 0; }
	/** In the local map and not revisited: odometry can be trusted between then and now. */
	bool isOfThisTime(ObjectId id) const { return contains(id) && !isRevisited(id); }
	/** Everything seen over the last metres. */
	std::set<ObjectId> objects() const;
	/** The same without revisited objects. */
	std::set<ObjectId> query() const;

	/** After a loop closure: absorbed is kept from now on, and what is in view agrees with the map. */
	void merge(ObjectId kept, ObjectId absorbed);
	void loopClosed() { revisited_.clear(); }
	void remove(ObjectId id);

	double path() const { return path_; }  //!< travelled so far [m]

private:
	LocalMapOptions options_;
	double path_ = 0.0;
	std::map<ObjectId, double> lastSeen_;  //!< object -> path when last seen [m]
	std::set<ObjectId> revisited_;
};

}  // namespace semloop
