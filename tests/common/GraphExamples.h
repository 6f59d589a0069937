#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/object_map/SemanticGraph.h>

#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace semloop::fixtures
{
inline GraphVertex vertex(ObjectId id, const std::string& label, double x, double y, double z)
{
	GraphVertex v;
	v.id = id;
	v.label = label;
	v.position = {x, y, z};
	return v;
}

/** All pairs share an edge. */
inline SemanticGraph complete(std::vector<GraphVertex> vertices)
{
	SemanticGraph graph;
	graph.vertices = std::move(vertices);
	for (std::size_t b = 0; b < graph.vertices.size(); ++b)
		for (std::size_t a = 0; a < b; ++a) graph.edges.insert({a, b});
	return graph;
}

/** Chair, table, cup and lamp at distances that are all different. */
inline SemanticGraph fourObjects()
{
	return complete(
		{vertex(10, "chair", 0, 0, 0.4), vertex(11, "table", 1.5, 0, 0.7),
		 vertex(12, "cup", 1.2, 0.9, 1.0), vertex(13, "lamp", -0.4, 2.0, 1.4)});
}

/** `objects` vertices of `labels` labels in a room of 5 x 4 x 2 m, all pairs co-visible. */
inline SemanticGraph randomRoom(std::size_t objects, int labels, unsigned seed)
{
	std::mt19937 random(seed);
	std::uniform_real_distribution<double> unit(0, 1);
	std::vector<GraphVertex> vertices;
	for (std::size_t i = 0; i < objects; ++i)
	{
		const auto label = "label" + std::to_string(static_cast<int>(unit(random) * labels));
		const double x = 5 * unit(random), y = 4 * unit(random), z = 2 * unit(random);
		vertices.push_back(vertex(i, label, x, y, z));
	}
	return complete(vertices);
}

inline SemanticGraph moved(SemanticGraph graph, const mrpt::poses::CPose3D& T)
{
	for (auto& v : graph.vertices) v.position = T.composePoint(v.position);
	return graph;
}

/** Vertex i of the result is vertex order[i] of the graph. */
inline SemanticGraph reordered(const SemanticGraph& graph, const std::vector<std::size_t>& order)
{
	SemanticGraph result;
	std::vector<std::size_t> newIndex(order.size());
	for (std::size_t i = 0; i < order.size(); ++i)
	{
		result.vertices.push_back(graph.vertices[order[i]]);
		newIndex[order[i]] = i;
	}
	for (const auto& [a, b] : graph.edges)
		result.edges.insert(std::minmax(newIndex[a], newIndex[b]));
	return result;
}

/** Both graphs in one, without edges between them; ids of the second continue. */
inline SemanticGraph united(SemanticGraph first, const SemanticGraph& second)
{
	const std::size_t offset = first.vertices.size();
	for (auto v : second.vertices)
	{
		v.id += 1000;
		first.vertices.push_back(v);
	}
	for (const auto& [a, b] : second.edges) first.edges.insert({a + offset, b + offset});
	return first;
}

}  // namespace semloop::fixtures
