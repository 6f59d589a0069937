#include <semloop/object_map/SemanticGraph.h>

#include <algorithm>

namespace semloop
{
namespace
{
GraphVertex vertexOf(const CObjectMap& map, const Object& object)
{
	GraphVertex vertex;
	vertex.id = object.id;
	vertex.label = map.labelName(object);
	vertex.position = object.centre();
	for (const auto& [label, score] : object.labelScores)
		vertex.labelScores[map.labels().name(label)] = score;
	vertex.embeddings = object.embeddings;
	vertex.extent = object.extent();
	object.T_world_object.getAsQuaternion(vertex.orientation.emplace());
	vertex.observations = object.observations;
	vertex.completeness = object.seenSides.completeness();
	return vertex;
}

/** Edges of the co-visible pairs among the vertices, which are in the order of their ids. */
void addCovisibility(SemanticGraph& graph, const CObjectMap& map)
{
	std::map<ObjectId, std::size_t> indexOf;
	for (std::size_t i = 0; i < graph.vertices.size(); ++i) indexOf[graph.vertices[i].id] = i;
	for (const auto& [id, index] : indexOf)
		for (const auto& [other, count] : map.object(id).covisible)
			if (const auto found = indexOf.find(other);
				found != indexOf.end() && other != id && count > 0)
				graph.edges.insert(std::minmax(index, found->second));
}

template <class Wanted>
SemanticGraph graphOf(const CObjectMap& map, int minObservations, const Wanted& wanted)
{
	SemanticGraph graph;
	for (const auto& [id, object] : map.objects())
		if (object.observations >= minObservations && wanted(id))
			graph.vertices.push_back(vertexOf(map, object));
	addCovisibility(graph, map);
	return graph;
}
}  // namespace

GraphVertex SemanticGraph::vertexFrom(const CObjectMap& map, ObjectId id)
{
	return vertexOf(map, map.object(id));
}

bool SemanticGraph::hasEdge(std::size_t a, std::size_t b) const
{
	return edges.count(std::minmax(a, b)) > 0;
}

double SemanticGraph::distance(std::size_t a, std::size_t b) const
{
	return vertices.at(a).position.distanceTo(vertices.at(b).position);
}

SemanticGraph SemanticGraph::fromMap(
	const CObjectMap& map, const std::set<ObjectId>& subset, int minObservations)
{
	return graphOf(map, minObservations, [&](ObjectId id) { return subset.count(id) > 0; });
}

SemanticGraph SemanticGraph::fromMap(const CObjectMap& map, int minObservations)
{
	return graphOf(map, minObservations, [](ObjectId) { return true; });
}

}  // namespace semloop
