#pragma once

#include <semloop/loop_closure/GraphIndex.h>
#include <semloop/loop_closure/PlaceSearch.h>

#include <utility>
#include <vector>

namespace semloop
{
/** The map's objects that each object of the query may be, with what labels and embeddings say for it: the
 *  part of a match's evidence that no pose changes. */
class MatchCandidates
{
public:
	struct Candidate
	{
		float x, y, z;  //!< centre in the map [m]
		float weight;   //!< ln p(l_j | l_k) / p(l_j) + ln p(s_jk | same) / p(s_jk | different)
		std::uint32_t target;
		float variance;  //!< of both centres, for what was not seen of the objects [m^2]
	};

	/** Throws InputError as GraphIndex does, and when the embeddings of query and map differ in length. */
	MatchCandidates(
		const SemanticGraph& query, const GraphIndex& target, const LabelAgreement& agreement,
		const PlaceSearchOptions& options);

	std::size_t size() const { return points_.size(); }
	const mrpt::math::TPoint3D& point(std::size_t query) const { return points_[query]; }
	/** By x. */
	const std::vector<Candidate>& of(std::size_t query) const { return candidates_[query]; }
	/** Those of a list with x in [low, high]. */
	static std::pair<const Candidate*, const Candidate*> range(
		const std::vector<Candidate>& candidates, double low, double high);
	double bestWeight(std::size_t query) const;  //!< -infinity without candidates

	/** V: a cylinder whose radius is sqrt(2) times the spread, and as high as the query, at least 0.5 m. */
	double volume() const { return volume_; }
	const mrpt::math::TPoint3D& centroid() const { return centroid_; }
	/** Mean squared horizontal distance of the query's centres from the centroid [m^2]. */
	double spread() const { return spread_; }

private:
	void measure();

	std::vector<mrpt::math::TPoint3D> points_;
	std::vector<std::vector<Candidate>> candidates_;
	mrpt::math::TPoint3D centroid_;
	double spread_ = 0, volume_ = 0;
};

}  // namespace semloop
