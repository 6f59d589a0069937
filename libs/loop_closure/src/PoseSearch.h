#pragma once

#include <semloop/loop_closure/GraphMatcher.h>

#include <optional>
#include <utility>
#include <vector>

#include "CandidateIndex.h"
#include "YawPose.h"

namespace semloop
{
/** Least squares, see fitYawAndTranslation(). */
std::optional<YawPose> fitYawPose(
	const std::vector<std::pair<mrpt::math::TPoint3D, mrpt::math::TPoint3D>>& pairs);

/** A pose and what it explains. */
struct Solution
{
	YawPose pose;
	std::vector<Match> inliers;
	double misfit = 0;  //!< sum over the inliers
	double rmse = 0;    //!< of the inliers under pose [m]

	bool betterThan(const Solution& o) const
	{
		if (inliers.size() != o.inliers.size()) return inliers.size() > o.inliers.size();
		return misfit < o.misfit;
	}
};

/** The search for poses between one query and one target. */
class PoseSearch
{
public:
	PoseSearch(const SemanticGraph& query, const SemanticGraph& target, CandidateIndex index);
	PoseSearch(const PoseSearch&) = delete;  // counter_ refers to index_

	std::optional<Solution> bestOf(const std::vector<Match>& matches);
	/** Inliers of the best pose that differs from ours. */
	int bestRivalOf(const YawPose& ours, double rivalDistance);
	int inliersOf(const YawPose& pose) { return counter_.count(pose, 0).inliers; }

private:
	const mrpt::math::TPoint3D& queryPoint(std::size_t j) const { return index_.position(j); }
	const mrpt::math::TPoint3D& targetPoint(std::size_t k) const
	{
		return target_.vertices[k].position;
	}

	std::optional<YawPose> poseFromTwo(
		const mrpt::math::TPoint3D& q1, const mrpt::math::TPoint3D& q2,
		const mrpt::math::TPoint3D& t1, const mrpt::math::TPoint3D& t2) const;
	Solution explain(const YawPose& pose) const;
	Solution refine(const YawPose& pose) const;
	double poseDistance(const YawPose& a, const YawPose& b) const;
	template <class Visit>
	void forEachCandidatePose(const Visit& visit) const;

	const SemanticGraph& query_;  //!< its edges; positions are the index's
	const SemanticGraph& target_;
	CandidateIndex index_;
	SupportCounter counter_;
	mrpt::math::TPoint3D centroid_;  //!< of the query
	double spread_ = 0;  //!< mean squared horizontal distance of the query from its centroid [m^2]
};

}  // namespace semloop
