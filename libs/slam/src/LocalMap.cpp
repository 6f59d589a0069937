#include <mrpt/poses/Lie/SO.h>
#include <semloop/slam/LocalMap.h>

#include <algorithm>

namespace semloop
{
void LocalMapOptions::describe(OptionFields& f)
{
	f.number("length", length, 0.1, 1000, "path over which objects stay in the local map [m]");
	f.number("metres_per_radian", metresPerRadian, 0, 100, "path that a turn counts as [m/rad]");
	f.number(
		"path_between_loops", pathBetweenLoops, 0, 1000,
		"path after a loop closure before the next one is looked for [m]");
	f.number(
		"growth", growth, 0, 1000,
		"how much longer objects stay while it is ambiguous where they belong [m]");
}

void LocalMap::advance(const mrpt::poses::CPose3D& T_previous_camera)
{
	const double angle = mrpt::poses::Lie::SO<3>::log(T_previous_camera.getRotationMatrix()).norm();
	path_ += T_previous_camera.norm() + options_.metresPerRadian * angle;
	pathAtFrame_.push_back(path_);
}

bool LocalMap::contains(ObjectId id) const
{
	const auto it = lastSeen_.find(id);
	return it != lastSeen_.end() && path_ - it->second <= length();
}

std::size_t LocalMap::firstFrame() const
{
	const auto isOld = [&](double path, double now) { return now - path > length(); };
	const auto first = std::lower_bound(pathAtFrame_.begin(), pathAtFrame_.end(), path_, isOld);
	return std::size_t(first - pathAtFrame_.begin());
}

void LocalMap::keepGrowing(bool yes)
{
	if (!yes)
		growingFrom_.reset();
	else if (!growingFrom_)
		growingFrom_ = path_;
}

double LocalMap::length() const
{
	if (!growingFrom_) return options_.length;
	return options_.length + std::min(options_.growth, path_ - *growingFrom_);
}

std::set<ObjectId> LocalMap::objects() const
{
	std::set<ObjectId> result;
	for (const auto& entry : lastSeen_)
		if (contains(entry.first)) result.insert(entry.first);
	return result;
}

void LocalMap::merge(ObjectId kept, ObjectId absorbed)
{
	const auto it = lastSeen_.find(absorbed);
	if (it != lastSeen_.end())
	{
		const auto known = lastSeen_.find(kept);
		lastSeen_[kept] =
			known == lastSeen_.end() ? it->second : std::max(known->second, it->second);
	}
	remove(absorbed);
}

}  // namespace semloop
