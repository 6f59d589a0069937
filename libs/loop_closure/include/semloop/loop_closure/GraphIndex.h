#pragma once

#include <semloop/object_map/SemanticGraph.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace semloop
{
/** The vertices of a graph as the search for a place in it needs them: by label, each label's sorted by x,
 *  with how frequent the label is and, in one matrix, what they look like.
 *
 *  Throws InputError, naming the vertex, when a position or an embedding is not finite or embeddings differ
 *  in length. */
class GraphIndex
{
public:
	struct Entry
	{
		float x, y, z;         //!< centre [m]
		std::uint32_t vertex;  //!< index in the graph
	};

	explicit GraphIndex(const SemanticGraph& graph);

	std::size_t size() const { return points_.size(); }
	const mrpt::math::TPoint3D& point(std::size_t vertex) const { return points_[vertex]; }

	/** Every label has a number; kNoLabel when no vertex has it. */
	static constexpr int kNoLabel = -1;
	int labelNumber(const std::string& label) const;
	std::size_t labels() const { return byLabel_.size(); }
	int labelOf(std::size_t vertex) const { return labelOf_[vertex]; }
	/** By x. */
	const std::vector<Entry>& ofLabel(int number) const { return byLabel_[number]; }

	/** A column per vertex, of unit length, or zero where a vertex has no embedding; no rows when none has. Of
	 *  several embeddings the direction of their mean. */
	const Eigen::MatrixXf& embeddings() const { return embeddings_; }

	bool hasEmbedding(std::size_t vertex) const { return hasEmbedding_[vertex]; }

	/** Area of the rectangle round all centres, at least 4 [m^2]. */
	double area() const { return area_; }

private:
	std::vector<mrpt::math::TPoint3D> points_;
	std::map<std::string, int, std::less<>> numbers_;
	std::vector<int> labelOf_;
	std::vector<std::vector<Entry>> byLabel_;
	Eigen::MatrixXf embeddings_;
	std::vector<bool> hasEmbedding_;
	double area_ = 0;
};

}  // namespace semloop
