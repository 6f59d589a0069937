#pragma once

#include <mrpt/img/TCamera.h>
#include <mrpt/math/TBoundingBox.h>
#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/observations/CObservationInstances.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

namespace semloop
{
class CObjectMap;
class TsdfVolume;

/** How likely instances are, given the map and a pose. */
struct ObjectMapLikelihoodOptions : Options
{
	double unexplained = 0.1;    //!< q: share of detections that a good map does not explain
	double positionScale = 0.2;  //!< s [m]: a detection this far from its object agrees by half
	double maxDepth = 6.0;       //!< farther measurements are not looked at [m]

protected:
	void describe(OptionFields& fields) override;
};

/** log p(Z | x) of the instances Z in one image for many poses x, as particle filters ask for it. What does
 *  not depend on the pose is computed once; a pose then costs O(detections objects points).
 *
 *      log p(Z | x) = - min over one-to-one A of sum over k of c(k, A(k))
 *      c(k, j) = -log(q + (1 - q) p(l_k | l_j) d_f(k, j) g_kj(x)),   c(k, nothing) = -log q
 *
 *  p and d_f are those of Eq. (3) (d_f = 1 without embeddings on both sides). g says how well the
 *  places agree: with depth, g = 1 / (1 + (d / s)^2), d being the mean distance [m] of points on the
 *  detection's visible surface from the object's; a tail this heavy still tells near from far a metre
 *  away. The TSDF tells the distance near the surface, the object's box farther off. Without depth, g is
 *  the IoU of the instance's box and the image of the object's box. An empty image says nothing: 0. */
class ObservationLikelihood
{
public:
	/** The label sets of the two must be the same, unless the map is empty. Throws as
	 *  CObservationInstances::validate(), and InputError when embeddings have different sizes. */
	ObservationLikelihood(
		const CObjectMap& map, const CObservationInstances& observation,
		const ObjectMapLikelihoodOptions& options);

	/** Of the robot's pose (MRPT's frame); at most 0. */
	double log(const mrpt::poses::CPose3D& T_world_robot) const;

private:
	struct Landmark
	{
		Eigen::Isometry3d T_object_world;
		Eigen::AlignedBox3d box;  //!< in the object's frame
		/** Not shared: the map would copy a volume before it writes. Without it the box has to do. */
		std::weak_ptr<const TsdfVolume> volume;
	};
	struct Detection
	{
		cv::Rect box;
		std::vector<Eigen::Vector3d> points;  //!< in the camera's frame; empty: no depth
	};

	double agreement(
		const Detection& detection, const Landmark& landmark, const TsdfVolume* volume,
		const std::vector<Eigen::Vector3d>& p_world, const Eigen::Isometry3d& T_world_camera) const;

	ObjectMapLikelihoodOptions options_;
	mrpt::img::TCamera camera_;
	mrpt::poses::CPose3D T_robot_camera_;
	std::vector<Landmark> landmarks_;
	std::vector<Detection> detections_;
	Eigen::MatrixXd appearance_;  //!< p d_f: a row for each detection, a column for each landmark
};

}  // namespace semloop
