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
 *  What takes a vertex in throws InputError, naming it, with nothing changed, when its position or an embedding
 *  is not finite embeddings differ in length, or a label score is not in [0, 1]. */
class GraphIndex
{
public:
	struct Entry
	{
		float x, y, z;         //!< centre [m]
		std::uint32_t vertex;  //!< its number
	};

	GraphIndex() = default;
	/** Vertices have the numbers that they have in the graph. */
	explicit GraphIndex(const SemanticGraph& graph);

	/** @name Keeping it up to date: the time depends on the label's vertices, not on all
	 * @{ */
	void add(const GraphVertex& vertex);  //!< its number is size()
	void remove(std::size_t number);      //!< the last one takes its number
	/** @} */

	std::size_t size() const { return points_.size(); }
	ObjectId id(std::size_t vertex) const { return ids_[vertex]; }
	const mrpt::math::TPoint3D& point(std::size_t vertex) const { return points_[vertex]; }

	/** Of the centre, for what was not seen of the object [m^2]; see centreSigma(). */
	double centreVariance(std::size_t vertex) const { return centreVariances_[vertex]; }

	/** Every label has a number; kNoLabel when no vertex ever had it. */
	static constexpr int kNoLabel = -1;
	int labelNumber(const std::string& label) const;
	int labelNumbers() const { return int(byLabel_.size()); }
	std::size_t labels() const;  //!< that some vertex has
	const std::string& labelName(int number) const { return names_[std::size_t(number)]; }
	int labelOf(std::size_t vertex) const { return labelOf_[vertex]; }
	struct LabelShare
	{
		int label;
		float share;  //!< in (0, 1], the sum of a vertex's is 1
	};
	/** Of a vertex with label scores; empty when its label is certain. */
	const std::vector<LabelShare>& shares(std::size_t vertex) const { return shares_[vertex]; }
	bool hasUncertainLabels() const { return uncertain_ > 0; }
	/** By x. */
	const std::vector<Entry>& ofLabel(int number) const { return byLabel_[number]; }

	/** A column per vertex, of unit length, or zero where a vertex has no embedding; empty when none has. Of
	 *  several embeddings the direction of their mean. */
	Eigen::MatrixXf::ConstColsBlockXpr embeddings() const
	{
		return embeddings_.leftCols(embedded_ == 0 ? 0 : Eigen::Index(size()));
	}
	bool hasEmbedding(std::size_t vertex) const { return hasEmbedding_[vertex]; }

	/** Area of the rectangle round all centres, at least 4 [m^2]; 0 without any. */
	double area() const;

private:
	void append(const GraphVertex& vertex);
	int numberOf(const std::string& label);
	Entry entryOf(std::size_t vertex) const;
	void insertEntry(std::size_t vertex);
	void eraseEntry(std::size_t vertex);

	std::vector<ObjectId> ids_;
	std::vector<mrpt::math::TPoint3D> points_;
	std::vector<double> centreVariances_;
	std::map<std::string, int, std::less<>> numbers_;
	std::vector<std::string> names_;
	std::vector<int> labelOf_;
	std::vector<std::vector<LabelShare>> shares_;
	std::size_t uncertain_ = 0;  //!< vertices with shares
	std::vector<std::vector<Entry>> byLabel_;
	Eigen::MatrixXf embeddings_;  //!< with columns to spare
	std::vector<bool> hasEmbedding_;
	std::size_t embedded_ = 0;
};

}  // namespace semloop
