#include <semloop/loop_closure/MapIndex.h>

#include <iterator>

namespace semloop
{
const GraphIndex& MapIndex::update(
	const CObjectMap& map, const std::set<ObjectId>& subset, int minObservations)
{
	for (auto known = known_.begin(); known != known_.end();)
	{
		const auto next = std::next(known);
		if (!map.objects().count(known->first) || !subset.count(known->first) ||
			map.object(known->first).observations < minObservations)
			forget(known);
		known = next;
	}
	for (const ObjectId id : subset)
	{
		const auto found = map.objects().find(id);
		if (found == map.objects().end() || found->second.observations < minObservations) continue;
		const auto centre = found->second.centre();
		const auto known = known_.find(id);
		const bool isNew = known == known_.end();
		if (!isNew && known->second.observations == found->second.observations &&
			known->second.centre == centre)
			continue;
		++described_;
		if (!isNew) forget(known);
		index_.add(SemanticGraph::vertexFrom(map, id));
		known_[id] = {index_.size() - 1, found->second.observations, centre};
	}
	return index_;
}

void MapIndex::forget(std::map<ObjectId, Known>::iterator known)
{
	// The last one takes its number.
	known_.at(index_.id(index_.size() - 1)).vertex = known->second.vertex;
	index_.remove(known->second.vertex);
	known_.erase(known);
}

}  // namespace semloop
