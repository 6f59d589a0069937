#pragma once

#include <mrpt/math/CQuaternion.h>
#include <mrpt/math/TPoint3D.h>
#include <semloop/object_map/CObjectMap.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace semloop
{
/** One object as the graph sees it (Sec. III-C): centre, label, embeddings. */
struct GraphVertex
{
	ObjectId id = 0;
	std::string label;
	mrpt::math::TPoint3D position;                //!< centre, in the graph's world [m]
	std::map<std::string, double> labelScores;    //!< empty: the label is certain
	std::vector<std::vector<float>> embeddings;   //!< each of unit length; may be empty
	std::optional<mrpt::math::TVector3D> extent;  //!< along the object's axes [m]
	/** Of the object's axes in the graph's world; none: they are the world's. */
	std::optional<mrpt::math::CQuaternionDouble> orientation;
	int observations = 0;
	/** Share of the object's sides that were seen, [0, 1]; none: unknown, taken for 1. */
	std::optional<double> completeness;
};

/** G = (V, E): an edge joins two objects that were seen in the same local map. */
struct SemanticGraph
{
	std::vector<GraphVertex> vertices;
	std::set<std::pair<std::size_t, std::size_t>> edges;  //!< vertex indices, first < second

	bool hasEdge(std::size_t a, std::size_t b) const;
	double distance(std::size_t a, std::size_t b) const;  //!< of the centres [m]

	/** The objects of the map that are in `subset` and have been seen at least minObservations times. */
	static SemanticGraph fromMap(
		const CObjectMap& map, const std::set<ObjectId>& subset, int minObservations = 1);
	static SemanticGraph fromMap(const CObjectMap& map, int minObservations = 1);

	/** Throws std::out_of_range for an object that the map does not have. */
	static GraphVertex vertexFrom(const CObjectMap& map, ObjectId id);

	/** Format semloop.graph/1 (doc/file-formats.md). Throws InputError naming file and place. */
	static SemanticGraph load(const std::string& path);
	/** Objects by id, numbers rounded to 1e-6; of several embeddings the direction of their mean.
	 *  Throws InputError when a number is not finite, an id is repeated, or the file cannot be
	 *  written. */
	void save(const std::string& path) const;
};

}  // namespace semloop
