#pragma once

#include <semloop/loop_closure/GraphIndex.h>

#include <map>
#include <set>

namespace semloop
{
/** The GraphIndex of objects of a map that changes: only what changed since the last time is described
 *  again. */
class MapIndex
{
public:
	/** The objects of the map that are in `subset` and were seen at least minObservations times. An object has
	 *  changed when it was seen again, moved, or merged; one that GraphIndex does not take stays out of it
	 *  and throws InputError. */
	const GraphIndex& update(
		const CObjectMap& map, const std::set<ObjectId>& subset, int minObservations);

	/** Objects that update() had to describe, altogether. */
	std::size_t described() const { return described_; }

private:
	struct Known
	{
		std::size_t vertex = 0;
		int observations = 0;
		mrpt::math::TPoint3D centre;
	};
	void forget(std::map<ObjectId, Known>::iterator known);

	GraphIndex index_;
	std::map<ObjectId, Known> known_;
	std::size_t described_ = 0;
};

}  // namespace semloop
