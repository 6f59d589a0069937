#pragma once

#include <mrpt/poses/CPose3D.h>
#include <semloop/config/Options.h>
#include <semloop/loop_closure/OrbFeatures.h>

#include <Eigen/Core>
#include <optional>

namespace semloop
{
struct CameraVerificationOptions : Options
{
	double ratio = 0.8;          //!< Hamming distance of the best match / that of the second best
	int maxDistance = 64;        //!< Hamming distance of a match [bits of 256]
	double pixelSigma = 1.5;     //!< of a feature's place [pixel]
	double maxReprojection = 3;  //!< of an inlier [pixel]
	int iterations = 300;        //!< of RANSAC
	int minInliers = 25;

	void describe(OptionFields& fields) override;
};

/** Where one camera is, seen from another. */
struct CameraPose
{
	mrpt::poses::CPose3D T_target_query;  //!< of the optical frames
	/** Inverse covariance of a small motion d = (translation [m], rotation vector [rad]): T_target_query exp(d). */
	Eigen::Matrix<double, 6, 6> information;
	std::size_t inliers = 0;
};

/** Matches of two frames' features and how many of them one pose explains. */
struct CameraComparison
{
	std::size_t matches = 0;
	std::optional<CameraPose>
		pose;  //!< empty: fewer inliers than needed, or a pose that they leave open
};

/** Geometric verification of an image that was found by its appearance.
 *
 *  Descriptors are each other's nearest and pass the ratio test (D. Lowe, IJCV 2004). The target's points, where
 *  their depth is known, and the query's pixels give the pose by EPnP (V. Lepetit, F. Moreno-Noguer and P. Fua,
 *  IJCV 2009) in RANSAC, refined on the inliers. An inlier reprojects within max_reprojection and, where the query
 *  knows the depth, lies there within three standard deviations of the depth of structured light.
 *
 *  The information is sum J^T J / pixel_sigma^2 of the inliers' reprojections, with 1 cm and 0.5 degrees on top
 *  of its covariance for what the two images do not know of: calibration, rolling shutter, colour and depth taken
 *  at different times. The same input gives the same output. */
CameraComparison compareCameras(
	const OrbFeatures& query, const OrbFeatures& target, const CameraVerificationOptions& options);

}  // namespace semloop
